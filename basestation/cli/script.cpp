// SPDX-License-Identifier: Apache-2.0
#include "basestation/cli/script.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "basestation/cli/interrupt.hpp"
#include "basestation/cli/run_line.hpp"
#include "core/command/parse.hpp"
#include "core/command/words.hpp"
#include "core/config/node.hpp"

namespace adit::station::cli {
namespace {

/// Plays the lines of one operator.
struct Player {
  std::unique_ptr<client::Connection> client{};
  std::map<std::int64_t, std::string> open{};
};

class Play {
 public:
  explicit Play(const Options& options) : options_(options), started_(std::chrono::steady_clock::now()) {}

  Result<void> add(const std::string& name) {
    Options own = options_;
    own.name = name;
    auto socket = connect(own);
    if (!socket) return socket.error();
    Player& player = players_[name];
    player.client = std::make_unique<client::Connection>(std::move(*socket), "script");
    player.client->on_notice = [this, name](const Notice& notice) {
      if (!options_.json && notice.mine && players_.contains(name))
        std::printf("%7.1f %s* %s\n", now(), name.c_str(), notice.text.c_str());
    };
    player.client->notices();
    player.client->on_outcome = [this, name](std::int64_t id, const CommandOutcome& outcome) {
      Player& owner = players_[name];
      const auto found = owner.open.find(id);
      if (found == owner.open.end()) return;
      ++ended_;
      if (outcome.exit_code == kExitNoAnswer) ++unanswered_;
      if (outcome.exit_code != kExitDone && outcome.exit_code != kExitNoAnswer) ++refused_;
      event(name, found->second, &outcome);
      owner.open.erase(found);
    };
    return {};
  }

  void begin() { started_ = std::chrono::steady_clock::now(); }
  double now() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }
  void execute(const ScriptLine& next) {
    if (!next.say.empty() && !options_.json) std::printf("\n          %s\n", next.say.c_str());
    event(next.by, next.line, nullptr);
    Player& player = players_[next.by];
    player.open[player.client->execute(next.line)] = next.line;
  }
  /// Returns false if the connection to a station was lost.
  bool wait() {
    const int share = static_cast<int>(20 / players_.size()) + 1;
    return std::all_of(players_.begin(), players_.end(),
                       [&](auto& p) { return p.second.client->wait(share); });
  }
  bool idle() const {
    return std::all_of(players_.begin(), players_.end(), [](const auto& p) { return p.second.open.empty(); });
  }
  /// Says how many commands failed, and returns the exit code.
  int result() const {
    if (refused_ + unanswered_ == 0) return kExitDone;
    if (!options_.json)
      std::fprintf(stderr, "commands: %zu, refused: %zu, without an answer: %zu\n", ended_, refused_,
                   unanswered_);
    return refused_ > 0 ? kExitRefused : kExitNoAnswer;
  }
  void cancel() {
    for (auto& [name, player] : players_)
      for (const auto& [id, line] : player.open) player.client->cancel(id);
  }

 private:
  void event(const std::string& by, const std::string& line, const CommandOutcome* outcome) {
    if (options_.json) {
      nlohmann::json object{{"at", now()}, {"by", by}, {"do", line}};
      if (outcome) object["outcome"] = nlohmann::json::parse(outcome->json, nullptr, false);
      std::printf("%s\n", object.dump().c_str());
    } else if (!outcome) {
      std::printf("%7.1f %s> %s\n", now(), by.c_str(), line.c_str());
    } else {
      const std::string text = outcome->text + outcome->error;
      for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
        std::printf("%7.1f %s  %s\n", now(), by.c_str(), text.substr(at, end - at).c_str());
    }
    std::fflush(stdout);
  }

  Options options_;
  std::map<std::string, Player> players_{};
  std::size_t ended_{}, refused_{}, unanswered_{};
  std::chrono::steady_clock::time_point started_;
};

}  // namespace

Result<std::vector<ScriptLine>> read_script(const std::string& path) {
  auto root = config::load(path);
  if (!root) return root.error();
  std::vector<ScriptLine> script;
  (void)root->entries();  // Marks the other keys as used: they are for the rehearsal.
  for (const config::Node& node : root->list("script")) {
    ScriptLine line{node.number("at", config::within(0.0, 1e6)), node.text("by"), node.text("do"),
                    node.text("say", "")};
    if (node.has("by") && !command::valid_name(line.by))
      node.fail(Reason::bad_argument, "by: an operator's name was expected");
    if (node.has("do"))
      if (auto request = command::parse(line.line); !request)
        node.fail(request.error().reason, request.error().text);
    script.push_back(std::move(line));
  }
  if (auto good = root->finish(); !good) return good.error();
  std::stable_sort(script.begin(), script.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return script;
}

int play(const Options& options, const std::vector<ScriptLine>& script, bool all_operators) {
  std::vector<ScriptLine> mine;
  std::set<std::string> names;
  for (const ScriptLine& line : script) {
    if (!all_operators && line.by != options.name) continue;
    mine.push_back(line);
    names.insert(line.by);
  }
  if (mine.empty())
    return fail(options, kExitUsage,
                {Reason::bad_argument,
                 "the script has no lines by " + options.name + "; all operators' are played with --all"});
  Play play(options);
  for (const std::string& name : names)
    if (auto added = play.add(name); !added)
      return fail(options, exit_without_station(added.error()), added.error());
  play.begin();
  std::size_t next = 0;
  while (next < mine.size() || !play.idle()) {
    while (next < mine.size() && mine[next].at <= play.now()) play.execute(mine[next++]);
    if (!play.wait()) return fail(options, kExitNoAnswer, {Reason::no_answer, "a station went away"});
    if (interrupted()) {
      play.cancel();
      for (int i = 0; i < 40 && !play.idle(); ++i) play.wait();
      return 130;
    }
  }
  return play.result();
}

}  // namespace adit::station::cli
