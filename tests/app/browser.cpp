#include "app/browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace nephroid::test {
namespace {

using Json = nlohmann::json;

/// Longest wait for an answer; a page of the tests takes a second.
constexpr int kTimeout_ms = 60'000;

[[noreturn]] void becomeBrowser(const std::vector<char*>& argv, int in, int out) {
  // The ends of the pipes may already be 3 or 4: move them out of the way first.
  const int high_in = fcntl(in, F_DUPFD, 10), high_out = fcntl(out, F_DUPFD, 10);
  dup2(high_in, 3);
  dup2(high_out, 4);
  const int null = open("/dev/null", O_RDWR);
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(null, standard);
  execvp(argv[0], argv.data());
  _exit(127);
}

std::string decodeBase64(const std::string& text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFFU);
  }
  return bytes;
}

}  // namespace

Browser::Browser(const std::string& program, const std::string& profile) {
  std::vector<std::string> arguments{program,
                                     "--headless=new",
                                     "--no-sandbox",
                                     "--disable-gpu",
                                     "--disable-dev-shm-usage",
                                     "--no-first-run",
                                     "--remote-debugging-pipe",
                                     "--user-data-dir=" + profile,
                                     "about:blank"};
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  std::array<int, 2> in{}, out{};
  if (pipe2(in.data(), O_CLOEXEC) != 0 || pipe2(out.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("fork failed");
  if (child_ == 0) {
    setpgid(0, 0);
    becomeBrowser(argv, in[0], out[1]);
  }
  close(in[0]);
  close(out[1]);
  to_ = in[1], from_ = out[0];
  const Json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
  call("Page.enable");
}

Browser::~Browser() {
  close(to_);
  close(from_);
  // Its own group: the browser is many processes.
  kill(-child_, SIGKILL);
  waitpid(child_, nullptr, 0);
}

std::string Browser::receive() {
  while (true) {
    const std::size_t end = received_.find('\0');
    if (end != std::string::npos) {
      std::string message = received_.substr(0, end);
      received_.erase(0, end + 1);
      return message;
    }
    pollfd waiting{from_, POLLIN, 0};
    if (poll(&waiting, 1, kTimeout_ms) != 1) throw std::runtime_error("the browser does not answer");
    std::array<char, 65536> buffer{};
    const ssize_t count = read(from_, buffer.data(), buffer.size());
    if (count <= 0) throw std::runtime_error("the browser went away");
    received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

Json Browser::call(const std::string& method, const Json& parameters) {
  Json message{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string text = message.dump();
  if (write(to_, text.c_str(), text.size() + 1) != static_cast<ssize_t>(text.size() + 1))
    throw std::runtime_error("cannot write to the browser");
  while (true) {
    Json answer = Json::parse(receive());
    if (answer.value("id", 0) != last_id_) continue;  // an event
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer["error"].dump());
    return answer["result"];
  }
}

void Browser::open(const std::string& path, int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  call("Page.navigate", {{"url", "file://" + path}});
  evaluate("new Promise(done => document.readyState === 'complete' ? done() : addEventListener('load', done))");
}

Json Browser::evaluate(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (answer.contains("exceptionDetails")) throw std::runtime_error(answer["exceptionDetails"].dump());
  return answer["result"].value("value", Json());
}

void Browser::sendMouse(const char* type, double x, double y, bool pressed) {
  const bool is_click = std::string_view(type) != "mouseMoved";
  call("Input.dispatchMouseEvent", {{"type", type},
                                    {"x", x},
                                    {"y", y},
                                    {"button", pressed || is_click ? "left" : "none"},
                                    {"buttons", pressed ? 1 : 0},
                                    {"clickCount", is_click ? 1 : 0}});
}
void Browser::movePointer(double x, double y, bool pressed) { sendMouse("mouseMoved", x, y, pressed); }
void Browser::press(double x, double y) { sendMouse("mousePressed", x, y, true); }
void Browser::release(double x, double y) { sendMouse("mouseReleased", x, y, false); }

void Browser::turnWheel(double x, double y, double delta_y) {
  call("Input.dispatchMouseEvent", {{"type", "mouseWheel"}, {"x", x}, {"y", y}, {"deltaX", 0}, {"deltaY", delta_y}});
}

void Browser::type(const std::string& key) {
  call("Input.dispatchKeyEvent", {{"type", "keyDown"}, {"key", key}, {"text", key}});
  call("Input.dispatchKeyEvent", {{"type", "keyUp"}, {"key", key}});
}

std::string Browser::takeScreenshot() {
  return decodeBase64(call("Page.captureScreenshot", {{"format", "png"}})["data"]);
}

}  // namespace nephroid::test
