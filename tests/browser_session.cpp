#include "tests/browser_session.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace tests {

using nlohmann::json;
using std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds kLongestCall{60};
constexpr int kBrowserReads = 3;
constexpr int kBrowserWrites = 4;

[[noreturn]] void run_browser(int input, int output, const std::vector<std::string>& arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The two ends may already lie where they belong, each in the other's place.
  const int high_input = fcntl(input, F_DUPFD, 10);
  const int high_output = fcntl(output, F_DUPFD, 10);
  dup2(high_input, kBrowserReads);
  dup2(high_output, kBrowserWrites);
  const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int fd : {0, 1, 2}) dup2(nothing, fd);
  for (int fd = kBrowserWrites + 1; fd < 256; ++fd) close(fd);
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execvp(argv[0], argv.data());
  _exit(127);
}

std::vector<std::string> command(const std::filesystem::path& profile,
                                 const BrowserSession::Options& options) {
  std::vector<std::string> words{"chromium",
                                 "--headless",
                                 "--no-sandbox",
                                 "--disable-gpu",
                                 "--enable-unsafe-swiftshader",
                                 "--disable-quic",
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--disable-component-update",
                                 "--disable-sync",
                                 "--hide-scrollbars",
                                 "--remote-debugging-pipe",
                                 "--user-data-dir=" + profile.string(),
                                 "--window-size=" + std::to_string(options.width_px) + "," +
                                     std::to_string(options.height_px)};
  words.insert(words.end(), options.arguments.begin(), options.arguments.end());
  words.emplace_back("about:blank");
  return words;
}

std::string code_of(const std::string& key) {
  if (key == " ") return "Space";
  if (key.size() != 1) return key;
  const char letter = key[0];
  if (std::isdigit(static_cast<unsigned char>(letter)) != 0) return "Digit" + key;
  if (std::isalpha(static_cast<unsigned char>(letter)) != 0) {
    return std::string("Key") + static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return "";
}

/// What a digit key writes with shift, on the keyboard that the protocol speaks of.
std::string shifted(const std::string& key) {
  constexpr std::string_view kSigns = ")!@#$%^&*(";
  const bool is_digit = key.size() == 1 && std::isdigit(static_cast<unsigned char>(key[0])) != 0;
  return is_digit ? std::string(1, kSigns[static_cast<std::size_t>(key[0] - '0')]) : key;
}

std::string bytes_of_base64(const std::string& text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0;
  int bits = 0;
  for (const char digit : text) {
    const std::size_t value = kDigits.find(digit);
    if (value == std::string_view::npos) break;
    group = group << 6U | static_cast<unsigned>(value);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> static_cast<unsigned>(bits) & 255U);
  }
  return bytes;
}

}  // namespace

BrowserSession::BrowserSession(const std::filesystem::path& profile)
    : BrowserSession(profile, Options()) {}

BrowserSession::BrowserSession(const std::filesystem::path& profile, const Options& options) {
  signal(SIGPIPE, SIG_IGN);  // a browser that ended is an exception, not the test's end
  std::array<int, 2> to{};
  std::array<int, 2> from{};
  if (pipe2(to.data(), O_CLOEXEC) != 0 || pipe2(from.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error("no pipe to the browser");
  }
  const std::vector<std::string> words = command(profile, options);
  pid_ = fork();
  if (pid_ == 0) {
    setpgid(0, 0);
    run_browser(to[0], from[1], words);
  }
  setpgid(pid_, pid_);
  close(to[0]);
  close(from[1]);
  to_browser_ = to[1];
  from_browser_ = from[0];
  const json target = call("Target.createTarget", {{"url", "about:blank"}});
  session_ = call("Target.attachToTarget",
                  {{"targetId", target["targetId"]}, {"flatten", true}})["sessionId"];
  for (const char* domain : {"Page", "Runtime", "Log"}) {
    call(std::string(domain) + ".enable", json::object());
  }
  call("Emulation.setDeviceMetricsOverride", {{"width", options.width_px},
                                              {"height", options.height_px},
                                              {"deviceScaleFactor", 1},
                                              {"mobile", false}});
  call("Emulation.setEmulatedMedia",
       {{"features", json::array({{{"name", "prefers-color-scheme"},
                                   {"value", options.is_dark ? "dark" : "light"}}})}});
}

BrowserSession::~BrowserSession() {
  close(to_browser_);
  close(from_browser_);
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

void BrowserSession::send(const json& message) {
  const std::string text = message.dump() + '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(to_browser_, text.data() + sent, text.size() - sent);
    if (count < 0 && errno != EINTR) throw std::runtime_error("the browser is gone");
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
}

json BrowserSession::receive(steady_clock::time_point deadline) {
  for (;;) {
    const std::size_t end = received_.find('\0');
    if (end != std::string::npos) {
      json message = json::parse(received_.substr(0, end));
      received_.erase(0, end + 1);
      return message;
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - steady_clock::now());
    pollfd wanted{from_browser_, POLLIN, 0};
    if (left.count() <= 0 || poll(&wanted, 1, static_cast<int>(left.count())) == 0) {
      throw std::runtime_error("the browser does not answer");
    }
    std::array<char, 1 << 16> buffer{};
    const ssize_t count = read(from_browser_, buffer.data(), buffer.size());
    if (count == 0) throw std::runtime_error("the browser has ended");
    if (count > 0) received_.append(buffer.data(), static_cast<std::size_t>(count));
  }
}

void BrowserSession::note(const json& event) {
  const std::string method = event.value("method", "");
  if (method == "Page.loadEventFired") is_loaded_ = true;
  const json& what = event.contains("params") ? event["params"] : json::object();
  if (method == "Runtime.exceptionThrown") {
    console_.push_back("error: " + what["exceptionDetails"].dump());
  } else if (method == "Runtime.consoleAPICalled") {
    console_.push_back(what.value("type", "") + ": " + what["args"].dump());
  } else if (method == "Log.entryAdded") {
    const std::string text = what["entry"].value("text", "");
    // The software driver on its own screenshots.
    const bool is_of_the_driver = text.find("GPU stall due to ReadPixels") != std::string::npos;
    if (!is_of_the_driver) console_.push_back(what["entry"].value("level", "") + ": " + text);
  }
}

json BrowserSession::call(const std::string& method, const json& parameters) {
  const int id = ++last_id_;
  json message{{"id", id}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) message["sessionId"] = session_;
  send(message);
  const auto deadline = steady_clock::now() + kLongestCall;
  for (;;) {
    const json answer = receive(deadline);
    if (answer.value("id", 0) != id) {
      note(answer);
      continue;
    }
    if (answer.contains("error")) throw std::runtime_error(method + ": " + answer.dump());
    return answer["result"];
  }
}

void BrowserSession::open(const std::filesystem::path& page, const std::string& hash) {
  // A change of the hash alone would not load the page again.
  call("Page.navigate", {{"url", "about:blank"}});
  is_loaded_ = false;
  call("Page.navigate", {{"url", "file://" + page.string() + hash}});
  const auto deadline = steady_clock::now() + kLongestCall;
  while (!is_loaded_) note(receive(deadline));
  wait_for("document.readyState === 'complete' && location.protocol === 'file:'");
}

json BrowserSession::evaluate(const std::string& expression) {
  const json result = call("Runtime.evaluate", {{"expression", expression},
                                                {"awaitPromise", true},
                                                {"returnByValue", true},
                                                {"userGesture", true}});
  if (result.contains("exceptionDetails")) {
    throw std::runtime_error(expression + ": " + result["exceptionDetails"].dump());
  }
  return result["result"].value("value", json());
}

bool BrowserSession::wait_for(const std::string& expression) {
  const auto deadline = steady_clock::now() + std::chrono::seconds(20);
  while (steady_clock::now() < deadline) {
    if (evaluate("Boolean(" + expression + ")") == true) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

void BrowserSession::key(const char* type, const std::string& key, Held held) {
  const std::string name = held == Held::shift ? shifted(key) : key;
  json event{
      {"type", type}, {"key", name}, {"code", code_of(key)}, {"modifiers", static_cast<int>(held)}};
  // The browser itself closes dialogs, and looks at the code of the key for that.
  constexpr int kEscape = 27;
  if (key == "Escape") event["windowsVirtualKeyCode"] = kEscape;
  if (std::strcmp(type, "keyDown") == 0 && name.size() == 1) event["text"] = name;
  call("Input.dispatchKeyEvent", event);
}

void BrowserSession::key_down(const std::string& name, Held held) { key("keyDown", name, held); }
void BrowserSession::key_up(const std::string& name, Held held) { key("keyUp", name, held); }

void BrowserSession::press(const std::string& name, Held held) {
  key_down(name, held);
  key_up(name, held);
}

void BrowserSession::mouse(const json& event) { call("Input.dispatchMouseEvent", event); }

void BrowserSession::move_to(double x, double y) {
  mouse({{"type", "mouseMoved"}, {"x", x}, {"y", y}});
}

void BrowserSession::click(double x, double y) { drag(x, y, x, y); }

void BrowserSession::drag(double from_x, double from_y, double to_x, double to_y, Held held) {
  const int keys = static_cast<int>(held);
  move_to(from_x, from_y);
  const auto event = [&](const char* type, double x, double y, int buttons) {
    mouse({{"type", type},
           {"x", x},
           {"y", y},
           {"button", "left"},
           {"buttons", buttons},
           {"clickCount", 1},
           {"modifiers", keys}});
  };
  event("mousePressed", from_x, from_y, 1);
  if (from_x != to_x || from_y != to_y) {
    event("mouseMoved", (from_x + to_x) / 2, (from_y + to_y) / 2, 1);
    event("mouseMoved", to_x, to_y, 1);
  }
  event("mouseReleased", to_x, to_y, 0);
}

void BrowserSession::wheel(double x, double y, double delta_y) {
  mouse({{"type", "mouseWheel"}, {"x", x}, {"y", y}, {"deltaX", 0}, {"deltaY", delta_y}});
}

void BrowserSession::screenshot(const std::filesystem::path& path) {
  const json result = call("Page.captureScreenshot", {{"format", "png"}});
  const std::string bytes = bytes_of_base64(result["data"]);
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

}  // namespace tests
