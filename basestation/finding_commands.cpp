// SPDX-License-Identifier: Apache-2.0
// The commands `finding N ...`: what the operator decides about a finding.
#include "basestation/model/json_reports.hpp"
#include "basestation/station_impl.hpp"
#include "core/command/vocabulary.hpp"

namespace adit::station {
namespace {

using command::Request;
using command::verb;

Outcome refused(const Request& request, const Error& error) {
  Outcome outcome{.exit_code = 1, .error = "finding: " + error.text + "\n"};
  outcome.json = {{"command", request.info->name},
                  {"exit", 1},
                  {"ok", false},
                  {"reason", name(error.reason)},
                  {"error", error.text}};
  return outcome;
}

Verdict verdict_of(const std::string& word) {
  if (word == "confirm") return Verdict::confirmed;
  return word == "reject" ? Verdict::rejected : Verdict::open;
}

std::string note_of(const Request& request) {
  const command::ArgumentValue* text = request.find("TEXT");
  std::string note;
  if (text)
    for (const std::string& word : text->words) note += (note.empty() ? "" : " ") + word;
  return note;
}

}  // namespace

void Station::Impl::judge_finding(const Request& request, const Done& done) {
  const double number = request.number("N");
  const auto whole = static_cast<std::uint32_t>(number);
  const findings::Key* found = static_cast<double>(whole) == number ? book_.key_of(whole) : nullptr;
  if (!found || !desk_.all().contains(*found))
    return done(refused(request, {Reason::out_of_range,
                                  "there is no finding of that number; `findings` lists "
                                  "them"}));
  const findings::Key key = *found;
  const auto written = [this, request, done, key, whole](const Result<void>& stored) {
    if (!stored) return done(refused(request, {stored.error().reason, "not stored: " + stored.error().text}));
    const FindingBook::Entry& entry = *book_.find(key);
    const bool notes = request.verb == verb("finding note");
    Outcome outcome{.text = "finding " + std::to_string(whole) + " of " + key.robot + " is " +
                            to_string(entry.verdict) + "\n"};
    if (notes)
      outcome.text = "finding " + std::to_string(whole) + " of " + key.robot +
                     (entry.note.empty() ? " has no note\n" : " has the note: " + entry.note + "\n");
    outcome.json = {{"command", request.info->name},
                    {"exit", 0},
                    {"ok", true},
                    {"number", whole},
                    {"robot", key.robot},
                    {"id", findings::id_text(key.id)},
                    {"verdict", to_string(entry.verdict)},
                    {"note", entry.note}};
    done(outcome);
  };
  if (request.verb == verb("finding note")) return book_.note(key, note_of(request), written);
  book_.judge(key, verdict_of(request.word("VERDICT")), written);
}

}  // namespace adit::station
