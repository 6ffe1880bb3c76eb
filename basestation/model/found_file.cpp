// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/found_file.hpp"

#include <algorithm>
#include <cmath>

#include "basestation/model/json.hpp"
#include "basestation/model/text.hpp"

namespace adit::station {
namespace {

std::string csv_cell(std::string text) {
  if (!text.empty() && std::string("=+-@\t\r").find(text[0]) != std::string::npos) text.insert(0, "'");
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

const char* yes_no(bool value) { return value ? "yes" : "no"; }

bool is_placed(const FoundItem& item) {
  return std::ranges::all_of(item.position, [](double axis) { return std::isfinite(axis); });
}

}  // namespace

std::string found_csv(const FoundReport& report) {
  std::string out = "number,robot,id,kind,importance,x,y,z,age,verdict,text,note,withdrawn,mark\r\n";
  for (const FoundItem& item : report.findings) {
    out += std::to_string(item.number) + "," + csv_cell(item.robot) + "," + csv_cell(item.id) + "," +
           csv_cell(item.kind) + "," + std::to_string(item.importance);
    for (const double axis : item.position) out += "," + (std::isfinite(axis) ? fixed(axis, 3) : "");
    out += "," + (item.age ? fixed(*item.age, 0) : "") + "," + to_string(item.verdict) + "," +
           csv_cell(item.text) + "," + csv_cell(item.note) + "," + yes_no(item.withdrawn) + "," +
           yes_no(item.mark) + "\r\n";
  }
  return out;
}

std::string found_geojson(const FoundReport& report) {
  nlohmann::json features = nlohmann::json::array();
  for (const FoundItem& item : report.findings) {
    nlohmann::json properties{{"number", item.number},
                              {"robot", item.robot},
                              {"id", item.id},
                              {"kind", item.kind},
                              {"importance", item.importance},
                              {"verdict", to_string(item.verdict)},
                              {"text", item.text},
                              {"note", item.note},
                              {"withdrawn", item.withdrawn},
                              {"mark", item.mark}};
    if (item.age) properties["age"] = *item.age;
    nlohmann::json geometry;
    if (is_placed(item)) geometry = {{"type", "Point"}, {"coordinates", item.position}};
    features.push_back({{"type", "Feature"}, {"geometry", geometry}, {"properties", properties}});
  }
  return line_of({{"type", "FeatureCollection"},
                  {"frame", "map, m: coordinates are no degrees"},
                  {"features", features}}) +
         "\n";
}

}  // namespace adit::station
