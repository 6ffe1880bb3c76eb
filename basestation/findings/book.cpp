// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/book.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "basestation/model/json.hpp"
#include "basestation/model/json_fields.hpp"
#include "core/command/words.hpp"

namespace adit::station {
namespace {

using nlohmann::json;

constexpr const char* kFile = "judgements";
constexpr int kVersion = 1;
constexpr std::size_t kMaxBytes = std::size_t{32} << 20;

/// A finding in the file.
struct StoredJudgement {
  std::string robot{}, id{}, owner{};  ///< `owner` empty: unknown.
  FindingBook::Judgement judgement{};
};

template <class Io>
void fields(Io& io, Of<Io, StoredJudgement>& row) {
  io.field("robot", row.robot);
  io.field("id", row.id);
  if (Io::kReads || !row.owner.empty()) io.field("owner", row.owner);
  io.field("number", row.judgement.number);
  io.word("verdict", row.judgement.verdict, Verdict::rejected, [](Verdict v) { return to_string(v); });
  io.field("note", row.judgement.note);
}

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
  std::vector<StoredJudgement> rows;
  in.read("version", version);
  in.read("findings", rows);
  if (!wrong.empty() || version != kVersion || rows.size() > kMaxEntries) return false;
  std::set<std::uint32_t> numbers;
  for (auto& [robot, id, owner, judgement] : rows) {
    findings::Key key{.robot = robot};
    const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), key.id, 16);
    if (error != std::errc() || end != id.data() + id.size() || !findings::read_owner(owner, key.owner) ||
        judgement.number == 0 || !numbers.insert(judgement.number).second)
      return false;
    judgement.note = command::clean(judgement.note, kMaxNote);
    next_ = std::max(next_, judgement.number + 1);
    entries_[key] = std::move(judgement);
  }
  return true;
}

std::string FindingBook::as_text() const {
  std::vector<StoredJudgement> rows;
  for (const auto& [key, judgement] : entries_)
    rows.push_back({key.robot, findings::id_text(key.id),
                    key.owner == findings::Owner{} ? "" : findings::owner_text(key.owner), judgement});
  return line_of({{"version", kVersion}, {"findings", JsonWriter::of(rows)}});
}

void FindingBook::add(const findings::Key& key) {
  if (entries_.contains(key) || entries_.size() >= kMaxEntries) return;
  entries_[key].number = next_++;
  changed({});
}

const FindingBook::Judgement* FindingBook::find(const findings::Key& key) const {
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
  if (on_change) on_change();
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
