// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/book.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "basestation/model/json_reader.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

using nlohmann::json;

constexpr const char* kFile = "judgements";
constexpr int kVersion = 1;
constexpr std::size_t kMaxBytes = std::size_t{32} << 20;

}  // namespace

FindingBook::FindingBook(std::shared_ptr<store::Disk> disk, Executor& home)
    : disk_(std::move(disk)), home_(home) {}

FindingBook::~FindingBook() = default;

std::string FindingBook::load() {
  if (!disk_) return {};
  const auto bytes = disk_->read(kFile, kMaxBytes);
  if (!bytes) {
    // What cannot be read now is not replaced.
    disk_.reset();
    return "judgements of findings cannot be read and are not stored: " + bytes.error().text;
  }
  if (!*bytes || read(std::string((*bytes)->begin(), (*bytes)->end()))) return {};
  entries_.clear();
  next_ = 1;
  const std::string bad = std::string(kFile) + ".bad";
  if (!disk_->rename(kFile, bad)) disk_.reset();
  return "judgements of findings were damaged, or of another version; the file is now " + bad;
}

bool FindingBook::read(const std::string& text) {
  const json object = json::parse(text, nullptr, false);
  std::string wrong;
  JsonReader in(object, wrong);
  int version = 0;
  in.read("version", version);
  if (version != kVersion) return false;
  std::set<std::uint32_t> numbers;
  in.each("findings", [&](const json& row) {
    std::string misfit, id;
    findings::Key key;
    Entry entry;
    JsonReader one(row, misfit);
    one.read("robot", key.robot);
    one.read("id", id);
    one.read("number", entry.number);
    one.word("verdict", entry.verdict, Verdict::rejected, [](Verdict v) { return to_string(v); });
    one.read("note", entry.note);
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), key.id, 16);
    if (!misfit.empty() || error != std::errc() || end != id.data() + id.size() || entry.number == 0)
      return false;
    if (!numbers.insert(entry.number).second) return false;
    entry.note = command::clean(entry.note, kMaxNote);
    next_ = std::max(next_, entry.number + 1);
    entries_[key] = std::move(entry);
    return entries_.size() <= kMaxEntries;
  });
  return wrong.empty();
}

std::string FindingBook::as_text() const {
  json rows = json::array();
  for (const auto& [key, entry] : entries_)
    rows.push_back({{"robot", key.robot},
                    {"id", findings::id_text(key.id)},
                    {"number", entry.number},
                    {"verdict", to_string(entry.verdict)},
                    {"note", entry.note}});
  const json object{{"version", kVersion}, {"findings", rows}};
  return object.dump(-1, ' ', true, json::error_handler_t::replace);
}

void FindingBook::add(const findings::Key& key) {
  if (entries_.contains(key) || entries_.size() >= kMaxEntries) return;
  entries_[key].number = next_++;
  changed({});
}

const FindingBook::Entry* FindingBook::find(const findings::Key& key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? nullptr : &found->second;
}

const findings::Key* FindingBook::key_of(std::uint32_t number) const {
  for (const auto& [key, entry] : entries_)
    if (entry.number == number) return &key;
  return nullptr;
}

void FindingBook::judge(const findings::Key& key, Verdict verdict, Written written) {
  entries_.at(key).verdict = verdict;
  changed(std::move(written));
}

void FindingBook::note(const findings::Key& key, const std::string& text, Written written) {
  entries_.at(key).note = command::clean(text, kMaxNote);
  changed(std::move(written));
}

void FindingBook::changed(Written written) {
  changed_ = true;
  if (written) waiting_.push_back(std::move(written));
  write();
}

void FindingBook::write() {
  if (writing_ || !changed_) return;
  changed_ = false;
  std::vector<Written> waiting = std::exchange(waiting_, {});
  if (!disk_) {
    for (const Written& written : waiting) written({});
    return;
  }
  if (disk_->instant()) {
    const std::string text = as_text();
    const auto done =
        disk_->replace(kFile, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    changed_ = !done;
    for (const Written& written : waiting) written(done);
    return;
  }
  writing_ = true;
  home_.compute(
      {.name = "judgements", .modelled = 3ms, .watchdog = 60s, .pool = PoolKind::io},
      [disk = disk_, text = as_text()] {
        return disk->replace(kFile, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
      },
      [this, waiting = std::move(waiting), alive = std::weak_ptr(alive_)](const Result<void>& done) {
        if (alive.expired()) return;
        writing_ = false;
        if (!done) changed_ = true;  // The next change tries again.
        for (const Written& written : waiting) written(done);
        if (done) write();
      });
}

}  // namespace adit::station
