#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace tests {

/// Keys held during an input event, as the protocol counts them.
enum class Held { none = 0, shift = 8 };

/// Debian's Chromium without a window, driven over its DevTools protocol: real keys, real pointer
/// events, real pixels. The protocol runs over two pipes, so no port is taken.
///
/// Source: https://chromedevtools.github.io/devtools-protocol/ and `--remote-debugging-pipe`.
class BrowserSession {
 public:
  struct Options {
    int width_px = 1280;
    int height_px = 800;
    bool is_dark = false;
    std::vector<std::string> arguments;  ///< added to the browser's own
  };

  /// Starts the browser. @param profile  a folder for its files
  /// @throws std::runtime_error if it does not start
  explicit BrowserSession(const std::filesystem::path& profile);
  BrowserSession(const std::filesystem::path& profile, const Options& options);
  ~BrowserSession();
  BrowserSession(const BrowserSession&) = delete;
  BrowserSession& operator=(const BrowserSession&) = delete;

  /// Opens a page from disk and waits for its load event. @param hash  "" or "#..."
  void open(const std::filesystem::path& page, const std::string& hash = "");

  /// The value of an expression in the page, a promise's once it is kept.
  /// @throws std::runtime_error with the page's error
  nlohmann::json evaluate(const std::string& expression);
  /// Evaluates until the value is true. @return false after 20 s
  bool wait_for(const std::string& expression);

  /// Presses and releases a key by its name ("d", "D", "ArrowLeft", " ", "3").
  void press(const std::string& key, Held held = Held::none);
  void key_down(const std::string& key, Held held = Held::none);
  void key_up(const std::string& key, Held held = Held::none);

  /// Pointer events at a place of the window, CSS pixels.
  void move_to(double x, double y);
  void click(double x, double y);
  void drag(double from_x, double from_y, double to_x, double to_y, Held held = Held::none);
  void wheel(double x, double y, double delta_y);

  /// What is seen, as a PNG. @param path  is written
  void screenshot(const std::filesystem::path& path);

  /// Everything the page wrote to the console so far, and its uncaught errors.
  const std::vector<std::string>& console() const { return console_; }

 private:
  nlohmann::json call(const std::string& method, const nlohmann::json& parameters);
  nlohmann::json receive(std::chrono::steady_clock::time_point deadline);
  void send(const nlohmann::json& message);
  void note(const nlohmann::json& event);
  void key(const char* type, const std::string& key, Held held);
  void mouse(const nlohmann::json& event);

  pid_t pid_ = -1;
  int to_browser_ = -1;
  int from_browser_ = -1;
  int last_id_ = 0;
  bool is_loaded_ = false;
  std::string session_;
  std::string received_;
  std::vector<std::string> console_;
};

}  // namespace tests
