// `nephroid devices`: what there is to compute on, what each device lacks, and which one `auto` takes.
#include "app/cli/devices.h"

#include <fmt/format.h>

#include "app/cli/command.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"

namespace nephroid::cli {
namespace {

using Json = nlohmann::ordered_json;
using gpu::DeviceInfo;
using gpu::DeviceSurvey;

constexpr const char* kExamples = R"(Examples:
  nephroid devices
  nephroid devices --json

It ends with exit code 0 whatever it finds: that there is no device is an
answer, too.)";

struct DevicesOptions {
  bool json = false;
};

std::string formatMemory(std::uint64_t bytes) {
  constexpr double kMebi = 1 << 20, kGibi = 1 << 30;
  const auto size = static_cast<double>(bytes);
  return size < kGibi ? fmt::format("{:.0f} MiB", size / kMebi) : fmt::format("{:.1f} GiB", size / kGibi);
}

std::string formatExtras(const DeviceInfo& device) {
  std::vector<std::string> there, absent;
  const auto sort = [&](bool has, const char* name) { (has ? there : absent).emplace_back(name); };
  sort(device.float_atomics, "float atomics");
  sort(device.int64_atomics, "64-bit atomics");
  sort(device.ray_tracing_pipeline, "ray tracing pipeline");
  sort(device.timestamp_period_ns > 0, "timestamps");
  if (there.empty()) return fmt::format("none (no {})", fmt::join(absent, ", no "));
  return fmt::format("{}{}", fmt::join(there, ", "),
                     absent.empty() ? "" : fmt::format(" (no {})", fmt::join(absent, ", no ")));
}

std::string formatDevice(std::size_t number, const DeviceInfo& device) {
  std::string text = fmt::format("{}  {}\n", number, toOneLine(device.name));
  const auto add = [&](const char* name, const std::string& value) {
    text += fmt::format("   {:<8} {}\n", name, toOneLine(value));
  };
  add("kind", device.kind);
  // Devices before Vulkan 1.3 are not asked for what follows, so silence is all that is true.
  if (!device.driver.empty()) add("driver", device.driver);
  add("Vulkan", device.api_version);
  add("memory", formatMemory(device.memory_bytes));
  add("usable", device.usable() ? "yes" : fmt::format("no, it lacks {}", fmt::join(device.missing, ", ")));
  if (device.usable()) add("extras", formatExtras(device));
  return text + "\n";
}

Json toJson(std::size_t number, const DeviceInfo& device) {
  return {{"device", number},
          {"name", device.name},
          {"kind", device.kind},
          {"driver", device.driver},
          {"vulkan", device.api_version},
          {"memory_bytes", device.memory_bytes},
          {"usable", device.usable()},
          {"missing", device.missing},
          {"float_atomics", device.float_atomics},
          {"int64_atomics", device.int64_atomics},
          {"ray_tracing_pipeline", device.ray_tracing_pipeline},
          {"timestamps", device.timestamp_period_ns > 0},
          {"timestamp_period_ns", device.timestamp_period_ns}};
}

ExitCode runDevices(const DevicesOptions& options) {
  const DeviceSurvey survey = gpu::surveyDevices();
  // Names are the driver's own: bytes that are no UTF-8 are replaced, not thrown at.
  writeStdout(options.json ? devicesToJson(survey).dump(2, ' ', false, Json::error_handler_t::replace) + "\n"
                           : formatDevices(survey));
  return ExitCode::kDone;
}

}  // namespace

std::string formatDevices(const DeviceSurvey& survey) {
  const std::string reason = toOneLine(survey.reason);
  if (survey.devices.empty()) return fmt::format("only the CPU: {}\n", reason);
  std::string text;
  for (std::size_t i = 0; i < survey.devices.size(); ++i) text += formatDevice(i, survey.devices[i]);
  return text + (survey.auto_device ? fmt::format("auto takes {}: {}\n", *survey.auto_device, reason)
                                    : fmt::format("auto takes none: {}\n", reason));
}

Json devicesToJson(const DeviceSurvey& survey) {
  Json list = Json::array();
  for (std::size_t i = 0; i < survey.devices.size(); ++i) list.push_back(toJson(i, survey.devices[i]));
  return {{"devices", list},
          {"auto", survey.auto_device ? Json(*survey.auto_device) : Json(nullptr)},
          {"reason", survey.reason}};
}

Command addDevicesCommand(CLI::App& root) {
  const auto options = std::make_shared<DevicesOptions>();
  CLI::App* app = addCommand(root, "devices",
                             "List the Vulkan devices, what each lacks, and which one --device auto takes.", kExamples);
  addSwitch(*app, "--json", options->json, "Print JSON.");
  return {app, [options] { return runDevices(*options); }};
}

}  // namespace nephroid::cli
