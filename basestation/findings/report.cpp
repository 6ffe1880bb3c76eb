// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "basestation/findings/placed.hpp"
#include "basestation/model/json.hpp"
#include "basestation/report/table.hpp"
#include "basestation/report/text.hpp"
#include "core/command/words.hpp"
#include "core/findings/object_data.hpp"

namespace adit::station {
namespace {

using findings::Finding;

std::vector<const Finding*> chosen(const FindingDesk& desk, const std::vector<std::string>& robots) {
  std::vector<const Finding*> rows;
  for (const auto& [key, finding] : desk.all())
    if (robots.empty() || std::find(robots.begin(), robots.end(), key.robot) != robots.end())
      rows.push_back(&finding);
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Finding* a, const Finding* b) { return a->importance > b->importance; });
  return rows;
}

/// Age of a finding by the robot's clock, s; negative: unknown.
double age(const Finding& finding, const Fleet& fleet) {
  const RobotView* robot = fleet.robot(finding.key.robot);
  if (!robot || !robot->located || robot->stamp < finding.stamp) return -1.0;
  return static_cast<double>(robot->stamp - finding.stamp) * 1e-9;
}

FoundPhoto found_photo(const findings::PhotoRef& ref, const findings::PhotoStore& photos) {
  const findings::PhotoState state = photos.state(ref.content);
  const PhotoHere part = state.thumbnail ? PhotoHere::thumbnail : PhotoHere::none;
  return {state.whole ? PhotoHere::whole : part, state.percent, ref.bytes, findings::id_text(ref.content)};
}

std::string verdict_text(const FoundItem& item) {
  if (!item.withdrawn) return to_string(item.verdict);
  return item.verdict == Verdict::open ? "withdrawn" : to_string(item.verdict) + std::string(", withdrawn");
}

/// A row of the report, and whether it is of a robot's own detector.
struct Row {
  FoundItem item{};
  bool object{};
};

double distance(const FoundItem& a, const FoundItem& b) {
  const auto &p = a.position, &q = b.position;
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

bool is_same_object(const FoundItem& a, const FoundItem& b) {
  return !a.withdrawn && !b.withdrawn && a.kind == b.kind && distance(a, b) <= kSameObject;
}

/// Adds an object to the row that stands for it.
void fold(const Row& row, Row& first) {
  FoundItem& item = first.item;
  item.also.push_back(row.item.number);
  item.text += ", also by " + row.item.robot;
  if (item.verdict == Verdict::open) item.verdict = row.item.verdict;
  if (!item.photo) item.photo = row.item.photo;
}

/// Lists each object once, in the order of the rows.
std::vector<FoundItem> without_doubles(std::vector<Row> rows) {
  std::vector<Row*> objects;
  for (Row& row : rows)
    if (row.object) objects.push_back(&row);
  std::ranges::stable_sort(objects, {}, [](const Row* row) { return row->item.number; });
  struct Group {
    Row* first{};
    std::set<std::string> robots{};
  };
  std::vector<Group> groups;
  std::set<const Row*> folded;
  for (Row* row : objects) {
    Group* known = nullptr;
    for (Group& group : groups) {
      if (group.robots.contains(row->item.robot) || !is_same_object(group.first->item, row->item)) continue;
      if (known == nullptr ||
          distance(group.first->item, row->item) < distance(known->first->item, row->item))
        known = &group;
    }
    if (known == nullptr) {
      groups.push_back({row, {row->item.robot}});
      continue;
    }
    known->robots.insert(row->item.robot);
    fold(*row, *known->first);
    folded.insert(row);
  }
  std::vector<FoundItem> out;
  for (Row& row : rows)
    if (!folded.contains(&row)) out.push_back(std::move(row.item));
  return out;
}

}  // namespace

FoundReport findings_report(const FindingDesk& desk, const FindingBook& book, const Marks& marks,
                            const findings::PhotoStore& photos, const ChunkStore& chunks, const Fleet& fleet,
                            const std::vector<std::string>& robots) {
  FoundReport report;
  std::map<std::string, std::uint32_t> here;
  std::vector<Row> rows;
  for (const Finding* f : chosen(desk, robots)) {
    FoundItem item{.robot = f->key.robot,
                   .id = findings::id_text(f->key.id),
                   .kind = command::clean(f->kind, Finding::kKind),
                   .importance = f->importance,
                   .position = placed(*f, chunks).position,
                   .text = command::clean(f->text, Finding::kText),
                   .withdrawn = f->withdrawn,
                   .mark = findings::marked_by(*f).has_value()};
    if (f->photo) item.photo = found_photo(*f->photo, photos);
    if (item.mark)
      item.age = marks.age(*f);
    else if (const double seconds_ago = age(*f, fleet); seconds_ago >= 0)
      item.age = seconds_ago;
    if (const FindingBook::Judgement* entry = book.find(f->key)) {
      item.number = entry->number;
      item.verdict = entry->verdict;
      item.note = entry->note;
    }
    ++here[item.robot];
    rows.push_back({std::move(item), findings::read_object(*f).has_value()});
  }
  report.findings = without_doubles(std::move(rows));
  for (const auto& [robot, says] : desk.robots())
    if (robots.empty() || std::find(robots.begin(), robots.end(), robot) != robots.end())
      report.at_robots.push_back(
          {.robot = robot, .stored = says.stored, .here = here[robot], .overflowed = says.overflowed});
  return report;
}

std::string findings_text(const FoundReport& report) {
  std::string out = "nothing was found yet\n";
  if (!report.findings.empty()) {
    std::vector<std::vector<std::string>> rows{
        {"N", "ROBOT", "KIND", "X", "Y", "Z", "AGE S", "VERDICT", "PHOTO", "TEXT", "NOTE", "ID"}};
    for (const FoundItem& item : report.findings)
      rows.push_back({std::to_string(item.number), item.robot + (item.mark ? " (mark)" : ""), item.kind,
                      fixed(item.position[0], 2), fixed(item.position[1], 2), fixed(item.position[2], 2),
                      item.age ? fixed(*item.age, 0) : "-", verdict_text(item), photo_text(item.photo),
                      item.text, item.note, item.id});
    out = table(rows);
  }
  for (const FoundAtRobot& robot : report.at_robots) {
    if (robot.stored > robot.here)
      out += robot.robot + " has " + std::to_string(robot.stored) + ", " + std::to_string(robot.here) +
             " are here\n";
    if (robot.overflowed > 0)
      out += robot.robot + " had no room for " + std::to_string(robot.overflowed) + " more\n";
  }
  return out;
}

nlohmann::json findings_json(const FoundReport& report, const FindingDesk& desk, const FindingBook& book) {
  nlohmann::json out = json_of(report);
  for (nlohmann::json& row : out["findings"]) {
    const findings::Key* key = book.key_of(row["number"].get<std::uint32_t>());
    const auto found = key ? desk.all().find(*key) : desk.all().end();
    if (found == desk.all().end()) continue;
    row["data"] = found->second.data;
    row["owner"] = findings::owner_text(key->owner);
  }
  return out;
}

}  // namespace adit::station
