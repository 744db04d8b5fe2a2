#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <thread>

#include <fmt/format.h>

#include "perception/image_file.h"
#include "tests/suites/command_line/program_test.h"

namespace tests {
namespace {

/// Accepts one connection and keeps all that comes, as a viewer would.
class FakeViewer {
 public:
  FakeViewer() {
    listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
        listen(listener_, 1) != 0 ||
        getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      ADD_FAILURE() << "no port to listen on";
    }
    port_ = ntohs(address.sin_port);
    thread_ = std::thread([this] { receive(); });
  }
  ~FakeViewer() {
    if (thread_.joinable()) thread_.join();
    close(listener_);
  }
  std::string address() const { return fmt::format("127.0.0.1:{}", port_); }
  /// Messages without their lengths, after the connection ended.
  std::vector<std::string> messages() {
    thread_.join();
    std::vector<std::string> list;
    for (std::size_t at = 0; at < bytes_.size();) {
      std::uint32_t size = 0;
      std::memcpy(&size, bytes_.data() + at, sizeof size);
      EXPECT_GE(size, sizeof size + 1);
      EXPECT_LE(at + size, bytes_.size());
      if (size <= sizeof size || at + size > bytes_.size()) break;
      list.push_back(bytes_.substr(at + sizeof size, size - sizeof size));
      at += size;
    }
    return list;
  }

 private:
  void receive() {
    const int connection = accept(listener_, nullptr, nullptr);
    char buffer[4096];
    for (ssize_t count = 0; (count = read(connection, buffer, sizeof buffer)) > 0;) {
      bytes_.append(buffer, static_cast<std::size_t>(count));
    }
    close(connection);
  }

  int listener_ = -1;
  int port_ = 0;
  std::string bytes_;
  std::thread thread_;
};

/// Reads a message's fields one after the other.
class Fields {
 public:
  explicit Fields(const std::string& bytes) : bytes_(bytes) {}
  template <class Number>
  Number number() {
    Number value{};
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  std::string text() {
    const std::string value = bytes_.c_str() + at_;
    at_ += value.size() + 1;
    return value;
  }
  std::string texts(int count) {
    std::string joined;
    for (int i = 0; i < count; ++i) joined += text();
    return joined;
  }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

class ViewVerb : public ProgramTest {
 protected:
  void SetUp() override {
    const std::string suite = write_text(
        "seen.yaml",
        "schema: 1\nsuite: seen\nviewing: {ppd: 60}\n"
        "scenes: [{id: spot, file: cornell-box-spot, size: [9, 7], reference: {samples: 8}}]\n"
        "methods: [{id: a, renderer: blank, parameters: {radiance: 0.5}},\n"
        "          {id: b, renderer: blank, parameters: {radiance: 2}}]\n"
        "metrics: [relmse]\n");
    ASSERT_EQ(discern({"run", suite}).exit.code, 0);
  }
};

TEST_F(ViewVerb, OpensTheReferenceAndEveryPicture) {
  FakeViewer viewer;
  const auto json = discern_json({"view", "last", "--viewer", viewer.address()}, "view");
  const std::vector<std::string> messages = viewer.messages();
  ASSERT_EQ(messages.size(), 3U);
  ASSERT_EQ(json["pictures"].size(), 3U);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    Fields fields(messages[i]);
    EXPECT_EQ(fields.number<std::uint8_t>(), 7);  // OpenImageV2
    EXPECT_EQ(fields.number<std::uint8_t>(), 0);
    const std::string file = fields.text();
    EXPECT_EQ(file, json["pictures"][i].get<std::string>());
    EXPECT_TRUE(std::filesystem::path(file).is_absolute());
    EXPECT_TRUE(std::filesystem::exists(file));
    EXPECT_EQ(fields.text(), "");
    EXPECT_EQ(fields.left(), 0U);
  }
  EXPECT_NE(json["pictures"][0].get<std::string>().find("reference.exr"), std::string::npos);
}

TEST_F(ViewVerb, SendsPixelsToAViewerElsewhere) {
  FakeViewer viewer;
  EXPECT_EQ(discern({"view", "last", "--filter", "^b$", "--send", "--viewer", viewer.address()})
                .exit.code,
            0);
  const std::vector<std::string> messages = viewer.messages();
  ASSERT_EQ(messages.size(), 4U) << "two images, each made and filled";
  Fields made(messages[2]);
  EXPECT_EQ(made.number<std::uint8_t>(), 4);  // CreateImage
  EXPECT_EQ(made.number<std::uint8_t>(), 0);
  EXPECT_EQ(made.text(), "spot b fixed");
  EXPECT_EQ(made.number<std::int32_t>(), 9);
  EXPECT_EQ(made.number<std::int32_t>(), 7);
  ASSERT_EQ(made.number<std::int32_t>(), 3);
  EXPECT_EQ(made.texts(3), "RGB");
  EXPECT_EQ(made.left(), 0U);
  Fields filled(messages[3]);
  EXPECT_EQ(filled.number<std::uint8_t>(), 6);  // UpdateImageV3
  EXPECT_EQ(filled.number<std::uint8_t>(), 0);
  EXPECT_EQ(filled.text(), "spot b fixed");
  ASSERT_EQ(filled.number<std::int32_t>(), 3);
  EXPECT_EQ(filled.texts(3), "RGB");
  EXPECT_EQ(filled.number<std::int32_t>(), 0);
  EXPECT_EQ(filled.number<std::int32_t>(), 0);
  EXPECT_EQ(filled.number<std::int32_t>(), 9);
  EXPECT_EQ(filled.number<std::int32_t>(), 7);
  for (std::int64_t offset = 0; offset < 3; ++offset) {
    EXPECT_EQ(filled.number<std::int64_t>(), offset);
  }
  for (int stride = 0; stride < 3; ++stride) EXPECT_EQ(filled.number<std::int64_t>(), 3);
  ASSERT_EQ(filled.left(), 9U * 7U * 3U * sizeof(float));
  EXPECT_EQ(filled.number<float>(), 2.0F);
}

TEST_F(ViewVerb, SaysWhatIsMissing) {
  expect_refused({"view", "last", "--viewer", "nowhere"},
                 "viewer \"nowhere\": must be HOST:PORT, such as 127.0.0.1:14158");
  expect_refused({"view", "last", "--viewer", "127.0.0.1:1"},
                 "no viewer answers at 127.0.0.1:1: Connection refused; start tev first", 4);
  const auto result = discern({"view", "last", "--filter", "horse"});
  EXPECT_EQ(result.exit.code, 2);
  EXPECT_NE(result.stderr_text.find("no picture of a row that matches \"horse\""),
            std::string::npos);
}

}  // namespace
}  // namespace tests
