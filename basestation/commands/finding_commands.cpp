// SPDX-License-Identifier: Apache-2.0
#include "basestation/commands/finding_commands.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <utility>

#include "basestation/map/floor_height.hpp"
#include "basestation/model/found_file.hpp"
#include "basestation/report/text.hpp"
#include "core/command/words.hpp"
#include "perception/map/export/map_file.hpp"

namespace adit::station {
namespace {

using command::Request;
using command::verb;
using namespace std::chrono_literals;

Outcome finding_refused(const Request& request, const Error& error) {
  return refused_outcome(request, error.reason, "finding: " + error.text, error.text);
}

Verdict verdict_of(const std::string& word) {
  if (word == "confirm") return Verdict::confirmed;
  return word == "reject" ? Verdict::rejected : Verdict::open;
}

/// The words of TEXT, with one space between them.
std::string text_argument(const Request& request) {
  const command::ArgumentValue* text = request.find("TEXT");
  std::string joined;
  if (text)
    for (const std::string& word : text->words) joined += (joined.empty() ? "" : " ") + word;
  return joined;
}

Outcome judged(const Request& request, const findings::Key& key, const FindingBook::Judgement& entry) {
  std::string text = "finding " + std::to_string(entry.number) + " of " + key.robot;
  if (request.verb != verb("finding note"))
    text += std::string(" is ") + to_string(entry.verdict);
  else
    text += entry.note.empty() ? " has no note" : " has the note: " + entry.note;
  return done_outcome(request, text + "\n",
                      {{"number", entry.number},
                       {"robot", key.robot},
                       {"id", findings::id_text(key.id)},
                       {"verdict", to_string(entry.verdict)},
                       {"note", entry.note}});
}

/// Reads and checks a photo. Errors: cannot_read, those of findings::make_photo().
Result<findings::Photo> photo_from(const std::string& file, const std::stop_token& stop) {
  std::error_code failed;
  const bool regular = std::filesystem::is_regular_file(file, failed);  // Opening a pipe would wait.
  std::ifstream in;
  if (regular) in.open(file, std::ios::binary | std::ios::ate);
  const std::streamoff size = regular && in ? static_cast<std::streamoff>(in.tellg()) : -1;
  if (size < 0) return Error{Reason::cannot_read, file + ": no such file, or it cannot be read"};
  // One that is too large is refused by its size.
  constexpr auto kMost = static_cast<std::streamoff>(findings::Photo::kMaxInput) + 1;
  store::Bytes bytes(static_cast<std::size_t>(std::min(size, kMost)));
  in.seekg(0);
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    return Error{Reason::cannot_read, file + " cannot be read"};
  auto photo = findings::make_photo(bytes, stop);
  if (!photo) return Error{photo.reason(), file + ": " + photo.error().text};
  return photo;
}

/// "finding 3: person at 12.00 4.00 0.20".
Outcome marked(const Request& request, const findings::Finding& mark, std::uint32_t number, bool on_disk) {
  const auto& [x, y, z] = mark.position;
  const std::string what = "finding " + std::to_string(number) + ", " + command::clean(mark.kind, 32);
  std::string text =
      mark.withdrawn ? what + ", is withdrawn"
                     : what + " at " + fixed(x, 2) + " " + fixed(y, 2) + " " + fixed(z, 2) + ", is marked";
  if (!on_disk) text += "; it is not on the disk yet, which does not answer";
  return done_outcome(request, text + "\n",
                      {{"number", number},
                       {"robot", mark.key.robot},
                       {"id", findings::id_text(mark.key.id)},
                       {"kind", mark.kind},
                       {"importance", mark.importance},
                       {"position", mark.position},
                       {"text", command::clean(mark.text, findings::Finding::kText)},
                       {"withdrawn", mark.withdrawn},
                       {"photo", mark.photo.has_value()},
                       {"on_disk", on_disk}});
}

}  // namespace

void FindingCommands::run(const Request& request, const Done& done) {
  if (request.verb == verb("finding add")) return add(request, done);
  const double number = request.number("N");
  const auto index = static_cast<std::uint32_t>(number);
  const findings::Key* found = static_cast<double>(index) == number ? content_.book().key_of(index) : nullptr;
  if (!found || !content_.desk().all().contains(*found))
    return done(finding_refused(
        request, {Reason::out_of_range, "there is no finding of that number; `findings` lists them"}));
  if (request.verb == verb("finding remove")) return remove(request, *found, done);
  if (request.verb == verb("finding photo")) return write_photo(request, *found, done);
  judge(request, *found, done);
}

void FindingCommands::add(const Request& request, const Done& done) {
  Mark mark{.kind = request.word("KIND"),
            .position = {request.number("X"), request.number("Y"), 0.0},
            .text = text_argument(request)};
  const double station_height = params_.place ? double{(*params_.place)[2]} : 0.0;
  if (request.has("Z"))
    mark.position[2] = request.number("Z");
  else
    mark.position[2] =
        floor_height(content_.chunks(), mark.position[0], mark.position[1], station_height).value_or(0.0);
  if (request.has("--photo")) return add_with_photo(request, mark, done);
  put(request, mark, done);
}

void FindingCommands::add_with_photo(const Request& request, const Mark& mark, const Done& done) {
  // A mark that is refused with its photo stores neither.
  strand_.compute(
      {.name = "mark's photo", .modelled = 300ms, .watchdog = 60s, .pool = PoolKind::io, .lane = "photo"},
      [file = request.word("--photo")](const std::stop_token& stop) { return photo_from(file, stop); },
      [this, request, mark, done, alive = std::weak_ptr(alive_)](const Result<findings::Photo>& made) {
        if (alive.expired()) return;
        if (!made) return done(finding_refused(request, made.error()));
        if (!content_.photos().put(*made, findings::usual_importance(mark.kind)))
          return done(finding_refused(request, {Reason::queue_full, "no room for one more photo"}));
        Mark with = mark;
        with.photo = findings::ref_of(*made);
        put(request, with, done);
      });
}

void FindingCommands::put(const Request& request, const Mark& mark, const Done& done) {
  const auto stored = [this, request, done](const findings::Finding& finding, bool on_disk) {
    const FindingBook::Judgement* entry = content_.book().find(finding.key);
    done(marked(request, finding, entry ? entry->number : 0, on_disk));
  };
  if (const auto added = content_.marks().add(mark, stored); !added)
    done(finding_refused(request, added.error()));
}

void FindingCommands::remove(const Request& request, const findings::Key& key, const Done& done) {
  const auto stored = [this, request, done](const findings::Finding& finding, bool on_disk) {
    const FindingBook::Judgement* entry = content_.book().find(finding.key);
    done(marked(request, finding, entry ? entry->number : 0, on_disk));
  };
  if (const auto removed = content_.marks().remove(key, stored); !removed)
    done(finding_refused(request, removed.error()));
}

void FindingCommands::write_photo(const Request& request, const findings::Key& key, const Done& done) {
  const findings::Finding& finding = content_.desk().all().at(key);
  if (!finding.photo) return done(finding_refused(request, {Reason::bad_argument, "it has no photo"}));
  const std::uint64_t content = finding.photo->content;
  const store::Bytes* whole = content_.photos().find(content, findings::PhotoPart::picture);
  const store::Bytes* bytes =
      whole != nullptr ? whole : content_.photos().find(content, findings::PhotoPart::thumbnail);
  const int percent = content_.photos().state(content).percent;
  if (bytes == nullptr)
    return done(finding_refused(request, {Reason::cannot_read, "nothing of its photo is here yet"}));
  const std::string file = request.word("FILE");
  strand_.compute(
      {.name = "photo file", .modelled = 20ms, .watchdog = 60s, .pool = PoolKind::io},
      [bytes = *bytes, file] { return perception::write_file_atomically(file, bytes); },
      [request, done, file, percent, is_whole = whole != nullptr,
       alive = std::weak_ptr(alive_)](const Result<void>& written) {
        if (alive.expired()) return;
        if (!written) return done(finding_refused(request, written.error()));
        const std::string text = is_whole ? "the photo is in " + file
                                          : "the thumbnail is in " + file + "; " + std::to_string(percent) +
                                                " % of the photo are here";
        done(done_outcome(request, text + "\n", {{"file", file}, {"whole", is_whole}, {"percent", percent}}));
      });
}

void FindingCommands::write_file(const Request& request, const Done& done) {
  const std::string file = request.word("--export");
  const auto not_written = [request](const Error& error) {
    return refused_outcome(request, error.reason, "findings: " + error.text, error.text);
  };
  const auto ending = std::filesystem::path(file).extension();
  if (ending != ".csv" && ending != ".geojson")
    return done(not_written({Reason::bad_argument, file + ": findings are written as .csv or .geojson"}));
  FoundReport report = content_.found(fleet_, request.robots);
  const std::size_t count = report.findings.size();
  strand_.compute(
      {.name = "findings file", .modelled = 20ms, .watchdog = 60s, .pool = PoolKind::io},
      [report = std::move(report), file, is_csv = ending == ".csv"] {
        return perception::write_file_atomically(file, [&](std::ostream& to) {
          to << (is_csv ? found_csv(report) : found_geojson(report));
          return Result<void>();
        });
      },
      [request, done, file, count, not_written, alive = std::weak_ptr(alive_)](const Result<void>& written) {
        if (alive.expired()) return;
        done(written ? done_outcome(request, std::to_string(count) + " findings are in " + file + "\n",
                                    {{"file", file}, {"count", count}})
                     : not_written(written.error()));
      });
}

void FindingCommands::judge(const Request& request, const findings::Key& key, const Done& done) {
  const auto written = [this, request, done, key](const Result<void>& stored) {
    done(stored ? judged(request, key, *content_.book().find(key))
                : finding_refused(request, {stored.error().reason, "not stored: " + stored.error().text}));
  };
  if (request.verb == verb("finding note")) return content_.book().note(key, text_argument(request), written);
  content_.book().judge(key, verdict_of(request.word("VERDICT")), written);
}

}  // namespace adit::station
