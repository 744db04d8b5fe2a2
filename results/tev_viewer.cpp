#include "results/tev_viewer.h"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "perception/base/errors.h"

namespace results {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are sent as they are");

enum class Kind : std::uint8_t { create_image = 4, update_image_v3 = 6, open_image_v2 = 7 };

constexpr std::size_t kMostMessageBytes = std::size_t{4} << 20;

class Message {
 public:
  explicit Message(Kind kind) {
    add(std::uint32_t{0});
    add(static_cast<std::uint8_t>(kind));
  }
  template <class Number>
  Message& add(Number number) {
    bytes_.append(reinterpret_cast<const char*>(&number), sizeof number);
    return *this;
  }
  Message& add_text(const std::string& text) {
    bytes_ += text;
    return add('\0');
  }
  Message& add_bytes(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
    return *this;
  }
  std::string finish() {
    const auto size = static_cast<std::uint32_t>(bytes_.size());
    std::memcpy(bytes_.data(), &size, sizeof size);
    return std::move(bytes_);
  }

 private:
  std::string bytes_;
};

constexpr std::uint8_t kKeepFocus = 0;

}  // namespace

std::string tev_open_message(const std::filesystem::path& path) {
  return Message(Kind::open_image_v2).add(kKeepFocus).add_text(path.string()).add_text("").finish();
}

std::string tev_create_message(const std::string& name, const perception::Image& image) {
  const std::vector<std::string>& channels = image.channels;
  Message message(Kind::create_image);
  message.add(kKeepFocus).add_text(name);
  message.add(std::int32_t{image.width_px}).add(std::int32_t{image.height_px});
  message.add(static_cast<std::int32_t>(channels.size()));
  for (const std::string& channel : channels) message.add_text(channel);
  return message.finish();
}

std::string tev_update_message(const std::string& name, const perception::Image& image, int begin,
                               int end) {
  const std::vector<std::string>& channels = image.channels;
  const auto count = static_cast<std::int64_t>(channels.size());
  Message message(Kind::update_image_v3);
  message.add(kKeepFocus).add_text(name).add(static_cast<std::int32_t>(count));
  for (const std::string& channel : channels) message.add_text(channel);
  message.add(std::int32_t{0}).add(std::int32_t{begin});
  message.add(std::int32_t{image.width_px}).add(std::int32_t{end - begin});
  for (std::int64_t offset = 0; offset < count; ++offset) message.add(offset);
  for (std::int64_t channel = 0; channel < count; ++channel) message.add(count);
  const auto row = static_cast<std::size_t>(image.width_px) * channels.size();
  message.add_bytes(image.pixels.data() + row * static_cast<std::size_t>(begin),
                    row * static_cast<std::size_t>(end - begin) * sizeof(float));
  return message.finish();
}

TevViewer::TevViewer(const std::string& address) : address_(address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == address.size()) {
    throw base::InputError(
        fmt::format("viewer \"{}\": must be HOST:PORT, such as 127.0.0.1:14158", address));
  }
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string host = address.substr(0, colon);
  const std::string port = address.substr(colon + 1);
  if (const int error = getaddrinfo(host.c_str(), port.c_str(), &hints, &found); error != 0) {
    throw base::InputError(fmt::format("viewer \"{}\": {}", address, gai_strerror(error)));
  }
  int reason = 0;
  for (const addrinfo* one = found; one != nullptr && socket_ < 0; one = one->ai_next) {
    socket_ = socket(one->ai_family, one->ai_socktype | SOCK_CLOEXEC, one->ai_protocol);
    if (socket_ >= 0 && connect(socket_, one->ai_addr, one->ai_addrlen) == 0) break;
    reason = errno;
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  freeaddrinfo(found);
  if (socket_ < 0) {
    throw base::DeviceError(fmt::format("no viewer answers at {}: {}; start tev first", address,
                                        std::strerror(reason)));
  }
}

TevViewer::~TevViewer() {
  if (socket_ >= 0) close(socket_);
}

void TevViewer::send(const std::string& message) const {
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t count =
        ::send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      throw base::DeviceError(
          fmt::format("the viewer at {} is gone: {}", address_, std::strerror(errno)));
    }
    sent += static_cast<std::size_t>(count);
  }
}

void TevViewer::send_image(const std::string& name, const perception::Image& image) const {
  send(tev_create_message(name, image));
  const std::size_t row_bytes = static_cast<std::size_t>(image.width_px) *
                                static_cast<std::size_t>(image.channel_count()) * sizeof(float);
  const int rows = static_cast<int>(std::max<std::size_t>(1, kMostMessageBytes / row_bytes));
  for (int begin = 0; begin < image.height_px; begin += rows) {
    send(tev_update_message(name, image, begin, std::min(begin + rows, image.height_px)));
  }
}

}  // namespace results
