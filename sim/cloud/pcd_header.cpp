// SPDX-License-Identifier: Apache-2.0
#include "sim/cloud/pcd_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>

namespace adit::sim {
namespace {

constexpr std::uint64_t kMostPoints = 10'000'000;
constexpr std::uint64_t kMostStep = 4096;             // bytes a point
constexpr std::uintmax_t kLongestHeader = 64 * 1024;  // bytes

struct Field {
  std::string name{};
  std::uint64_t size{0}, count{1};
  char type{0};
};

struct Header {
  std::vector<Field> fields{};
  std::uint64_t width{0}, height{0}, step{0};
  std::string data{};
  std::uint64_t points() const { return width * height; }
};

class Reader {
 public:
  Reader(std::string name, std::string bytes, std::uint64_t size)
      : name_(std::move(name)), bytes_(std::move(bytes)), size_(size) {}
  Result<void> read();

 private:
  Error wrong(const std::string& what) const {
    return {Reason::syntax, fmt::format("{}:{}: {}", name_, line_, what)};
  }
  bool next_line(std::string& line);
  Result<void> read_header();
  Result<void> take(const std::string& key, const std::vector<std::string>& words);
  Result<void> check();
  Result<void> viewpoint(const std::vector<std::string>& words);
  Result<void> check_size();

  std::string name_, bytes_;  ///< Bytes of the beginning of the file.
  std::uint64_t size_;        ///< Of the whole file, bytes.
  std::size_t at_{0};
  int line_{0};
  Header header_{};
};

bool number(const std::string& word, std::uint64_t& value) {
  const auto end = word.data() + word.size();
  const auto [p, error] = std::from_chars(word.data(), end, value);
  return error == std::errc{} && p == end;
}

bool number(const std::string& word, double& value) {
  const auto end = word.data() + word.size();
  const auto [p, error] = std::from_chars(word.data(), end, value);
  return error == std::errc{} && p == end;
}

bool Reader::next_line(std::string& line) {
  if (at_ >= bytes_.size()) return false;
  const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
  line = bytes_.substr(at_, end - at_);
  if (!line.empty() && line.back() == '\r') line.pop_back();
  at_ = end + 1;
  ++line_;
  return true;
}

Result<void> Reader::viewpoint(const std::vector<std::string>& words) {
  std::array<double, 7> v{};
  if (words.size() != v.size()) return wrong("VIEWPOINT has seven numbers: tx ty tz qw qx qy qz");
  for (std::size_t i = 0; i < v.size(); ++i)
    if (!number(words[i], v[i]) || !std::isfinite(v[i])) return wrong("VIEWPOINT: not a number: " + words[i]);
  const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
  if (q.norm() < 0.5 || q.norm() > 2.0) return wrong("VIEWPOINT: the quaternion has no unit length");
  return {};
}

Result<void> Reader::take(const std::string& key, const std::vector<std::string>& words) {
  const auto per_field = [&](const auto& use) -> Result<void> {
    if (words.size() != header_.fields.size()) return wrong(key + " does not have one entry a field");
    for (std::size_t i = 0; i < words.size(); ++i)
      if (!use(header_.fields[i], words[i])) return wrong(key + ": " + words[i]);
    return {};
  };
  const auto single = [&](std::uint64_t& value) -> Result<void> {
    if (words.size() != 1 || !number(words[0], value) || value > kMostPoints)
      return wrong(fmt::format("{} is one number up to {}", key, kMostPoints));
    return {};
  };
  if (key == "VERSION") return {};
  if (key == "FIELDS" || key == "COLUMNS") {
    for (const std::string& word : words) header_.fields.push_back({word});
    return {};
  }
  if (key == "SIZE")
    return per_field([](Field& f, const std::string& w) {
      return number(w, f.size) && (f.size == 1 || f.size == 2 || f.size == 4 || f.size == 8);
    });
  if (key == "TYPE")
    return per_field([](Field& f, const std::string& w) {
      f.type = w[0];
      return w == "I" || w == "U" || w == "F";
    });
  if (key == "COUNT")
    return per_field([](Field& f, const std::string& w) {
      return number(w, f.count) && f.count > 0 && f.count <= kMostStep;
    });
  if (key == "WIDTH") return single(header_.width);
  if (key == "HEIGHT") return single(header_.height);
  if (key == "VIEWPOINT") return viewpoint(words);
  if (key == "POINTS") {
    std::uint64_t points = 0;
    if (auto read = single(points); !read) return read;
    return points == header_.points() ? Result<void>{} : wrong("POINTS is not WIDTH times HEIGHT");
  }
  if (key == "DATA") {
    if (words.size() != 1) return wrong("DATA is ascii, binary or binary_compressed");
    header_.data = words[0];
    return {};
  }
  return wrong("unknown key " + key);
}

Result<void> Reader::read_header() {
  std::string line;
  while (header_.data.empty() && next_line(line)) {
    std::istringstream stream(line);
    std::string key;
    if (!(stream >> key) || key[0] == '#') continue;
    if (line_ > 100 || line.size() > 4096) return wrong("this is no PCD header");
    const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    if (auto taken = take(key, words); !taken) return taken;
  }
  return check();
}

Result<void> Reader::check() {
  if (header_.data.empty()) return wrong("the header has no DATA");
  if (header_.points() > kMostPoints)
    return Error{Reason::not_supported, fmt::format("{}: more than {} points", name_, kMostPoints)};
  for (Field& field : header_.fields) {
    if (field.size == 0 || field.type == 0) return wrong("SIZE or TYPE is missing");
    header_.step += field.size * field.count;
    if (header_.step > kMostStep) return wrong("a point is larger than 4 kB");
  }
  const std::array names{"x", "y", "z"};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto found = std::find_if(header_.fields.begin(), header_.fields.end(),
                                    [&](const Field& f) { return f.name == names[a]; });
    if (found == header_.fields.end()) return wrong(fmt::format("there is no field {}", names[a]));
    if (found->type != 'F' || found->size < 4 || found->count != 1)
      return wrong(fmt::format("field {} is no single float", names[a]));
  }
  return {};
}

/// What the header promises must fit into what follows it.
Result<void> Reader::check_size() {
  const std::uint64_t left = at_ <= bytes_.size() ? size_ - at_ : 0, plain = header_.points() * header_.step;
  if (header_.data == "binary")
    return left < plain ? wrong("the file ends before its last point") : Result<void>{};
  // A number and a blank are two bytes at least.
  std::uint64_t columns = 0;
  for (const Field& field : header_.fields) columns += field.count;
  if (header_.data == "ascii")
    return left + 1 < 2 * columns * header_.points()
               ? wrong(fmt::format("{} points do not fit into the rest of the file", header_.points()))
               : Result<void>{};
  if (header_.data != "binary_compressed") return wrong("DATA is ascii, binary or binary_compressed");
  if (left < 8 || bytes_.size() - at_ < 8) return wrong("the sizes of the data are missing");
  std::array<std::uint32_t, 2> sizes{};
  std::memcpy(sizes.data(), bytes_.data() + at_, 8);
  if (left - 8 < sizes[0]) return wrong("the file ends before its data");
  if (sizes[1] != plain) return wrong("the data do not hold POINTS points");
  return {};
}

Result<void> Reader::read() {
  if (auto header = read_header(); !header) return header;
  return check_size();
}

}  // namespace

Result<void> check_pcd(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream) return {Reason::cannot_read, file.string() + ": cannot be read"};
  std::string bytes(std::min<std::uintmax_t>(size, kLongestHeader), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, stream.gcount())));
  return Reader(file.string(), std::move(bytes), size).read();
}

}  // namespace adit::sim
