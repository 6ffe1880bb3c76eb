// SPDX-License-Identifier: Apache-2.0
#include "basestation/host/serve.hpp"

#include <signal.h>
#include <sys/signalfd.h>

#include <cstdio>
#include <cstring>
#include <future>

#include "basestation/client/paths.hpp"
#include "basestation/host/live_station.hpp"
#include "basestation/host/server.hpp"
#include "basestation/model/outcome.hpp"

namespace adit::station::host {
namespace {

void answer(int ready_fd, const std::string& text) {
  if (ready_fd < 0) return;
  (void)!::write(ready_fd, text.data(), text.size());
  ::close(ready_fd);
}

Result<void> run(const client::StationOptions& options, int ready_fd, const client::File& signals) {
  auto folder = client::runtime_folder();
  if (!folder) return folder.error();
  auto server = Server::open(*folder, options.name);
  if (!server) return server.error();
  auto live = LiveStation::open(options, {.ready =
                                              [&](Station& station) {
                                                station.on_notice = [&](const StoredNotice& notice) {
                                                  (*server)->notify(described(notice, notice.at));
                                                };
                                                station.on_changed = [&] { (*server)->changed(station); };
                                                station.on_down = [&] { (*server)->end(); };
                                              },
                                          .record = true});
  if (!live) return live.error();
  answer(ready_fd, "ready\n");
  const nlohmann::json hello{{"station", options.name},          {"pid", ::getpid()},
                             {"domain", options.domain},         {"link", options.link},
                             {"interfaces", options.interfaces}, {"peers", options.peers}};
  (*server)->serve((*live)->station(), (*live)->strand(), hello, signals.get());
  // Releases all robots after a signal, when no operator can answer any more: the log says what they do.
  command::Request down(command::verb("down"));
  down.values = {{.name = "--leave"}};
  const Outcome outcome = (*live)->execute(down, std::chrono::seconds(2));
  if (outcome.exit_code == kExitDone) std::fputs((outcome.text + outcome.error).c_str(), stderr);
  return {};
}

}  // namespace

int serve(const client::StationOptions& options, int ready_fd) {
  sigset_t set;
  sigemptyset(&set);
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&set, number);
  ::pthread_sigmask(SIG_BLOCK, &set,
                    nullptr);  // Set before any thread starts, so that all threads inherit it.
  const client::File signals(::signalfd(-1, &set, SFD_CLOEXEC));
  const auto ended = run(options, ready_fd, signals);
  if (ended) return kExitDone;
  answer(ready_fd, ended.error().text + "\n");
  std::fprintf(stderr, "basestation: %s\n", ended.error().text.c_str());
  return kExitRefused;
}

}  // namespace adit::station::host
