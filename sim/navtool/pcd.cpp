// SPDX-License-Identifier: Apache-2.0
#include "sim/navtool/pcd.hpp"

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
constexpr std::uint64_t kMostStep = 4096;  // bytes a point

struct Field {
  std::string name{};
  std::uint64_t size{0}, count{1}, offset{0};  // offset in the point, bytes
  char type{0};
};

struct Header {
  std::vector<Field> fields{};
  std::uint64_t width{0}, height{0}, step{0};
  std::array<std::size_t, 3> axis{};  // index of x, y and z in fields
  Pose3 viewpoint{};
  std::string data{};
  std::uint64_t points() const { return width * height; }
};

class Reader {
 public:
  Reader(std::string name, std::string bytes) : name_(std::move(name)), bytes_(std::move(bytes)) {}
  Result<PcdFile> read();

 private:
  Error wrong(const std::string& what) const {
    return {Reason::syntax, fmt::format("{}:{}: {}", name_, line_, what)};
  }
  bool next_line(std::string& line);
  Result<void> read_header();
  Result<void> take(const std::string& key, const std::vector<std::string>& words);
  Result<void> check();
  Result<void> viewpoint(const std::vector<std::string>& words);
  Result<PcdFile> ascii();
  Result<PcdFile> binary();
  Result<PcdFile> compressed();
  float value(const char* at, const Field& field) const;

  std::string name_, bytes_;
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
  header_.viewpoint = {{v[0], v[1], v[2]}, q.normalized()};
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
    field.offset = header_.step;
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
    header_.axis[a] = static_cast<std::size_t>(found - header_.fields.begin());
  }
  return {};
}

float Reader::value(const char* at, const Field& field) const {
  if (field.size == 8) {
    double v;
    std::memcpy(&v, at, 8);
    return static_cast<float>(v);
  }
  float v;
  std::memcpy(&v, at, 4);
  return v;
}

Result<PcdFile> Reader::ascii() {
  PcdFile file{{}, header_.viewpoint};
  std::size_t columns = 0;
  std::array<std::size_t, 3> column{};
  for (std::size_t i = 0; i < header_.fields.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      if (header_.axis[a] == i) column[a] = columns;
    columns += header_.fields[i].count;
  }
  std::string line;
  while (file.points.size() < header_.points()) {
    if (!next_line(line))
      return wrong(fmt::format("{} points are missing", header_.points() - file.points.size()));
    std::istringstream stream(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
    if (words.size() != columns) return wrong(fmt::format("a point has {} numbers", columns));
    Eigen::Vector3f p;
    for (std::size_t a = 0; a < 3; ++a) {
      double v = 0;
      if (!number(words[column[a]], v)) return wrong("not a number: " + words[column[a]]);
      p[static_cast<Eigen::Index>(a)] = static_cast<float>(v);
    }
    file.points.push_back(p);
  }
  return file;
}

Result<PcdFile> Reader::binary() {
  PcdFile file{{}, header_.viewpoint};
  const std::size_t left = at_ <= bytes_.size() ? bytes_.size() - at_ : 0;
  if (left < header_.points() * header_.step) return wrong("the file ends before its last point");
  file.points.resize(header_.points());
  for (std::size_t i = 0; i < file.points.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const Field& field = header_.fields[header_.axis[a]];
      file.points[i][static_cast<Eigen::Index>(a)] =
          value(bytes_.data() + at_ + i * header_.step + field.offset, field);
    }
  return file;
}

/// LZF, M. Lehmann's: literal runs and copies of what came before. False when the input is none.
bool decompress(std::string_view in, std::string& out, std::size_t size) {
  out.clear();
  out.reserve(size);
  for (std::size_t i = 0; i < in.size();) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(in[k]); };
    const unsigned control = byte(i++);
    if (control < 32) {
      const std::size_t run = control + 1;
      if (in.size() - i < run || size - out.size() < run) return false;
      out.append(in.substr(i, run));
      i += run;
      continue;
    }
    std::size_t run = control >> 5;
    if (run == 7) {
      if (i >= in.size()) return false;
      run += byte(i++);
    }
    if (i >= in.size()) return false;
    const std::size_t back = ((control & 31u) << 8) + byte(i++) + 1;
    run += 2;
    if (back > out.size() || size - out.size() < run) return false;
    for (std::size_t k = 0; k < run; ++k) out.push_back(out[out.size() - back]);
  }
  return out.size() == size;
}

Result<PcdFile> Reader::compressed() {
  if (at_ > bytes_.size() || bytes_.size() - at_ < 8) return wrong("the sizes of the data are missing");
  std::array<std::uint32_t, 2> sizes{};
  std::memcpy(sizes.data(), bytes_.data() + at_, 8);
  if (bytes_.size() - at_ - 8 < sizes[0]) return wrong("the file ends before its data");
  if (sizes[1] != header_.points() * header_.step) return wrong("the data do not hold POINTS points");
  std::string plain;
  if (!decompress(std::string_view(bytes_).substr(at_ + 8, sizes[0]), plain, sizes[1]))
    return wrong("the compressed data are damaged");
  PcdFile file{{}, header_.viewpoint};
  file.points.resize(header_.points());
  // Field after field, not point after point.
  for (std::size_t a = 0; a < 3; ++a) {
    const Field& field = header_.fields[header_.axis[a]];
    for (std::size_t i = 0; i < file.points.size(); ++i)
      file.points[i][static_cast<Eigen::Index>(a)] =
          value(plain.data() + field.offset * header_.points() + i * field.size, field);
  }
  return file;
}

Result<PcdFile> Reader::read() {
  if (auto header = read_header(); !header) return header.error();
  if (header_.data == "ascii") return ascii();
  if (header_.data == "binary") return binary();
  if (header_.data == "binary_compressed") return compressed();
  return wrong("DATA is ascii, binary or binary_compressed");
}

}  // namespace

Result<PcdFile> read_pcd(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  if (!stream.good() && !stream.eof()) return {Reason::cannot_read, file.string() + ": cannot be read"};
  return Reader(file.string(), std::move(bytes)).read();
}

Result<std::vector<std::filesystem::path>> pcd_files(const std::filesystem::path& folder) {
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().extension() == ".pcd" && entry.is_regular_file(error)) files.push_back(entry.path());
  if (files.empty()) return {Reason::cannot_read, folder.string() + ": no .pcd files there"};
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace adit::sim
