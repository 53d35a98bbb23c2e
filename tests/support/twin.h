// One function, three times over the same inputs: on the device, in C++, and in C++ with tracked numbers, whose bounds
// say how far the first two may be apart.
#pragma once

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/commands.h"
#include "support/tracked.h"

namespace nephroid::testing {

/// Runs a shader that turns inputs[count] (binding 0) into outputs[count] (binding 1) in groups of 64; `count` is its
/// push constant. Structs in scalar block layout: lists of 4-byte fields.
template <class Output, class Input>
std::vector<Output> runOnDevice(gpu::Device& device, gpu::Spirv shader, const std::vector<Input>& inputs) {
  static_assert(std::is_trivially_copyable_v<Input> && alignof(Input) == 4);
  static_assert(std::is_trivially_copyable_v<Output> && alignof(Output) == 4);
  gpu::CommandRecorder recorder(device);
  const gpu::ComputePipeline pipeline(
      device,
      {.shader = shader,
       .bindings = {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}, {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}},
       .push_bytes = 4},
      "twin");
  recorder.begin();
  const gpu::Buffer from =
      gpu::makeBuffer<Input>(device, recorder, inputs, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, "inputs");
  const gpu::Buffer to(device, inputs.size() * sizeof(Output), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                       gpu::MemoryIntent::kDevice, "outputs");
  const auto count = static_cast<std::uint32_t>(inputs.size());
  recorder.pass("twin", {{from, gpu::Access::kComputeRead}, {to, gpu::Access::kComputeWrite}},
                [&](gpu::PassCommands& commands) {
                  commands.bind(pipeline);
                  commands.bindResources({gpu::Bound(0, from), gpu::Bound(1, to)});
                  commands.pushConstants(count);
                  commands.dispatch(gpu::groupsOf(count, 64));
                });
  recorder.submit();
  recorder.wait();
  return gpu::readBackAs<Output>(device, to);
}

/// What a test claims of a function: at every input but `beyond` of them Vulkan's precision makes device and CPU agree
/// to absolute + relative·|value|, |value| being the length of a vector, and they do. At the others, next to a
/// singularity or a fork, they agree within the wider bound that holds there. So what is claimed is independent of the
/// device that the test runs on; whether it is kept is not.
struct Within {
  double absolute = 0, relative = 0;
  std::size_t beyond = 0;
};

/// Structs of floats only (vectors of them included) as they stand in memory.
template <class Struct>
std::span<const float> floatsOf(const Struct& s) {
  static_assert(sizeof(Struct) % sizeof(float) == 0 && alignof(Struct) == alignof(float));
  return {reinterpret_cast<const float*>(&s), sizeof(Struct) / sizeof(float)};
}

template <class Input, class Output, class TrackedInput, class TrackedOutput>
class TwinRun {
 public:
  /// @param on_cpu   the shader's function in C++
  /// @param tracked  the same with tracked numbers
  TwinRun(gpu::Device& device, gpu::Spirv shader, std::vector<Input> inputs, Output (*on_cpu)(Input),
          TrackedOutput (*tracked)(TrackedInput))
      : inputs_(std::move(inputs)), gpu_(runOnDevice<Output>(device, shader, inputs_)) {
    for (const Input& input : inputs_) {
      cpu_.push_back(on_cpu(input));
      paths_.emplace_back();
      const TrackedInput tracked_input = track(input);
      const bool all = tracked::Forks::forEachPath(kMaxPaths, [&](std::size_t) {
        TrackedOutput output = tracked(tracked_input);
        paths_.back().push_back({output, tracked::Forks::integersLost()});
      });
      EXPECT_TRUE(all) << "too many forks at " << describe(inputs_[paths_.size() - 1]);
    }
  }

  const std::vector<Input>& inputs() const { return inputs_; }
  const std::vector<Output>& gpu() const { return gpu_; }
  const std::vector<Output>& cpu() const { return cpu_; }

  /// @param get  takes one value out of an output, plain or tracked
  template <class Get>
  ::testing::AssertionResult agrees(const char* name, const Get& get, const Within& within) const {
    std::size_t worst = 0, first_beyond = 0, beyond = 0;
    double worst_share = -1, widest = 0;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      const auto gpu = componentsOf(get(gpu_[i])), cpu = componentsOf(get(cpu_[i]));
      const Judgement judgement = judge(i, gpu, cpu, get);
      if (!judgement.tracks_cpu)
        return ::testing::AssertionFailure() << name << ": the tracked text is not the plain one: " << at(i, gpu, cpu);
      double length = 0;
      for (const Component& c : cpu)
        if (std::isfinite(c.value)) length = std::hypot(length, c.value);
      // Subnormal numbers on the way to a result may be flushed; that is no tolerance of the function.
      const double stated = within.absolute + within.relative * length + kFlushed;
      if (judgement.bound > stated) {
        if (beyond++ == 0) first_beyond = i;
      } else if (length > 0) {
        widest = std::max(widest, judgement.bound / (within.relative > 0 ? length : 1.0));
      }
      if (judgement.share > worst_share) worst = i, worst_share = judgement.share;
    }
    ::testing::Test::RecordProperty(name, fmt::format("used {:.3f} of the bound, widest {:.3g}, beyond {} of {}",
                                                      worst_share, widest, beyond, inputs_.size()));
    const auto tell = [&](std::size_t i) {
      return at(i, componentsOf(get(gpu_[i])), componentsOf(get(cpu_[i]))) +
             fmt::format("  bound {:.3g}\n",
                         judge(i, componentsOf(get(gpu_[i])), componentsOf(get(cpu_[i])), get).bound);
    };
    if (worst_share > 1)
      return ::testing::AssertionFailure()
             << name << ": device and CPU differ by " << worst_share << " times the bound\n"
             << tell(worst);
    if (beyond > within.beyond)
      return ::testing::AssertionFailure() << name << ": Vulkan promises less than is claimed at " << beyond << " of "
                                           << inputs_.size() << " inputs, the first\n"
                                           << tell(first_beyond);
    return ::testing::AssertionSuccess();
  }

 private:
  /// Ways through a function that are tried.
  static constexpr std::size_t kMaxPaths = 1024;
  /// What a few hundred flushed numbers amount to.
  static constexpr double kFlushed = 256.0 * tracked::Number::kSmallestNormal;

  struct Path {
    TrackedOutput output;
    bool integers_lost;
  };
  struct Component {
    double value, error;
    bool is_integer;
  };
  struct Judgement {
    double share;     ///< of the bound that is used, along the path that the device is nearest to; above 1: wrong
    double bound;     ///< how far from the CPU the device may be, whichever path it takes
    bool tracks_cpu;  ///< the tracked text takes the CPU's values
  };

  static std::vector<Component> componentsOf(float v) { return {{v, 0, false}}; }
  static std::vector<Component> componentsOf(std::uint32_t v) { return {{static_cast<double>(v), 0, true}}; }
  static std::vector<Component> componentsOf(const glm::vec2& v) { return {{v.x, 0, false}, {v.y, 0, false}}; }
  static std::vector<Component> componentsOf(const glm::vec3& v) {
    return {{v.x, 0, false}, {v.y, 0, false}, {v.z, 0, false}};
  }
  static std::vector<Component> componentsOf(const tracked::Number& v) { return {{v.value, v.error, false}}; }
  static std::vector<Component> componentsOf(const tracked::vec2& v) {
    return {{v.x.value, v.x.error, false}, {v.y.value, v.y.error, false}};
  }
  static std::vector<Component> componentsOf(const tracked::vec3& v) {
    return {{v.x.value, v.x.error, false}, {v.y.value, v.y.error, false}, {v.z.value, v.z.error, false}};
  }

  static TrackedInput track(const Input& input) {
    const std::span<const float> floats = floatsOf(input);
    std::array<tracked::Number, sizeof(Input) / sizeof(float)> numbers;
    static_assert(sizeof(numbers) == sizeof(TrackedInput));
    std::copy(floats.begin(), floats.end(), numbers.begin());
    TrackedInput result;
    std::memcpy(static_cast<void*>(&result), numbers.data(), sizeof(result));
    return result;
  }

  /// Zero between equal infinities and between NaNs, infinite between a NaN and a number.
  static double distance(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0.0;
    return std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::infinity() : std::abs(a - b);
  }
  static double shareOfBound(double gpu, double cpu, double bound) {
    constexpr double kWrong = std::numeric_limits<double>::infinity();
    const double d = distance(gpu, cpu);
    if (std::isnan(gpu) != std::isnan(cpu)) return kWrong;
    if (d == 0 || bound == tracked::kUnbounded) return 0.0;
    return bound > 0 ? d / bound : kWrong;
  }

  template <class Get>
  Judgement judge(std::size_t i, const std::vector<Component>& gpu, const std::vector<Component>& cpu,
                  const Get& get) const {
    Judgement result{std::numeric_limits<double>::infinity(), 0, true};
    const auto natural = componentsOf(get(paths_[i].front().output));
    for (const Path& path : paths_[i]) {
      const auto expected = componentsOf(get(path.output));
      double share = 0, bound = 0;
      for (std::size_t c = 0; c < expected.size(); ++c) {
        // Of a lost integer any value may be right, but only one that differs has to be excused.
        const bool excused = expected[c].is_integer && path.integers_lost && gpu[c].value != expected[c].value;
        const double error = excused ? tracked::kUnbounded : expected[c].error;
        share = std::max(share, shareOfBound(gpu[c].value, expected[c].value, error));
        bound = std::hypot(bound, error + distance(natural[c].value, expected[c].value));
      }
      result.share = std::min(result.share, share);
      result.bound = std::max(result.bound, bound);
    }
    for (std::size_t c = 0; c < cpu.size(); ++c)
      if (distance(natural[c].value, cpu[c].value) != 0) result.tracks_cpu = false;
    return result;
  }

  static std::string describe(const Input& input) { return fmt::format("{:.9g}", fmt::join(floatsOf(input), " ")); }
  std::string at(std::size_t i, const std::vector<Component>& gpu, const std::vector<Component>& cpu) const {
    std::string text = fmt::format("  input {}: {}\n", i, describe(inputs_[i]));
    for (std::size_t c = 0; c < gpu.size(); ++c)
      text += fmt::format("  device {:.9g}  CPU {:.9g}\n", gpu[c].value, cpu[c].value);
    return text;
  }

  std::vector<Input> inputs_;
  std::vector<Output> gpu_, cpu_;
  std::vector<std::vector<Path>> paths_;
};

/// EXPECT_TWINS(run, field, {.relative = …}): device and CPU agree on one field of the outputs.
// Braces may hold commas, hence the variable arguments.
#define NEPHROID_EXPECT_TWINS(run, field, ...) \
  EXPECT_TRUE((run).agrees(                    \
      #field, [](const auto& result) { return result.field; }, ::nephroid::testing::Within __VA_ARGS__))

}  // namespace nephroid::testing
