#pragma once

#include <filesystem>
#include <string>

#include "perception/image.h"

/// Talks to the image viewer tev, and to all that speak its protocol.
///
/// A message is its length in bytes (uint32, the length itself included), a byte for its kind, and
/// fields: numbers little-endian, text ended by a zero byte. Source: tev, include/tev/Ipc.h and
/// src/Ipc.cpp of github.com/Tom94/tev (kinds 4 CreateImage, 6 UpdateImageV3, 7 OpenImageV2).
namespace results {

/// Opens a file that the viewer can read itself.
/// @param path  absolute
std::string tev_open_message(const std::filesystem::path& path);

/// Makes an image without pixels; an earlier one of that name is replaced.
std::string tev_create_message(const std::string& name, const perception::Image& image);

/// Rows [begin, end) of an image, all channels of a pixel together.
std::string tev_update_message(const std::string& name, const perception::Image& image, int begin,
                               int end);

/// A connection to a viewer; ends with the object.
class TevViewer {
 public:
  /// @param address  "host:port"
  /// @throws base::InputError if it is no address; base::DeviceError if nobody answers
  explicit TevViewer(const std::string& address);
  ~TevViewer();
  TevViewer(const TevViewer&) = delete;
  TevViewer& operator=(const TevViewer&) = delete;

  /// @throws base::DeviceError if the viewer is gone
  void send(const std::string& message) const;
  /// Sends the pixels of an image, some rows at a time.
  void send_image(const std::string& name, const perception::Image& image) const;

 private:
  std::string address_;
  int socket_ = -1;
};

}  // namespace results
