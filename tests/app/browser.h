// Drives a headless Chromium over its pipe: real pointer and keyboard input, and what the page then says.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace nephroid::test {

/// One page in a browser of its own, which ends with it. Speaks the DevTools protocol: messages of JSON that end with
/// a 0, to the browser's descriptor 3 and from its 4.
class Browser {
 public:
  /// @param program  Chromium  @param profile  an empty folder for its files
  /// @throws std::runtime_error here and in all that follows if the browser does not answer as it should
  Browser(const std::string& program, const std::string& profile);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Opens a file and waits until it is loaded.
  void open(const std::string& path, int width, int height);
  /// Value of an expression in the page; promises are waited for.
  nlohmann::json evaluate(const std::string& expression);
  void movePointer(double x, double y, bool pressed = false);
  void press(double x, double y);
  void release(double x, double y);
  void turnWheel(double x, double y, double delta_y);
  void type(const std::string& key);
  /// The page as a PNG.
  std::string takeScreenshot();

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters = nlohmann::json::object());
  void sendMouse(const char* type, double x, double y, bool pressed);
  std::string receive();

  int child_ = -1, to_ = -1, from_ = -1;
  int last_id_ = 0;
  std::string session_, received_;
};

}  // namespace nephroid::test
