#include "results/html_report/float_store.h"

#include <utility>

#include <fmt/format.h>

#include "perception/base/atomic_file.h"

namespace results::html_report {

namespace fs = std::filesystem;

namespace {

constexpr const char* kData = "data";
constexpr const char* kNewData = "data.new";

}  // namespace

FloatStore::FloatStore(Split split, fs::path folder, std::uint64_t split_above_bytes)
    : folder_(std::move(folder)),
      split_above_bytes_(split_above_bytes),
      may_split_(split != Split::never),
      is_split_(split == Split::always) {}

void FloatStore::put(std::size_t id, std::string base64) {
  const std::lock_guard lock(mutex_);
  bytes_ += base64.size();
  if (texts_.size() <= id) texts_.resize(id + 1);
  texts_[id] = std::move(base64);
  if (may_split_ && bytes_ > split_above_bytes_) is_split_ = true;
  if (is_split_) spill();
}

void FloatStore::spill() {
  for (std::size_t id = 0; id < texts_.size(); ++id) {
    if (texts_[id].empty()) continue;
    write(id);
    std::string().swap(texts_[id]);
  }
}

void FloatStore::write(std::size_t id) const {
  const fs::path path = folder_ / kNewData / fmt::format("f{}.js", id);
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  base::write_text_file(path, fmt::format("discernData(\"f{}\",\"{}\");\n", id, texts_[id]));
}

std::string FloatStore::put_file(const std::string& name, const std::string& bytes) const {
  std::error_code error;
  fs::create_directories(folder_ / kData, error);
  base::write_text_file(folder_ / kData / name, bytes);
  return fmt::format("{}/{}", kData, name);
}

void FloatStore::finish() {
  if (folder_.empty()) return;
  std::error_code error;
  fs::remove_all(folder_ / kData, error);
  if (is_split_) fs::rename(folder_ / kNewData, folder_ / kData, error);
}

std::string FloatStore::elements() const {
  std::string html;
  if (is_split_) return html;
  html.reserve(bytes_ + 64 * texts_.size());
  for (std::size_t id = 0; id < texts_.size(); ++id) {
    if (texts_[id].empty()) continue;
    html += fmt::format("<script type=\"text/plain\" id=\"f{}\">", id);
    html += texts_[id];
    html += "</script>\n";
  }
  return html;
}

}  // namespace results::html_report
