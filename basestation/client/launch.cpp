// SPDX-License-Identifier: Apache-2.0
#include "basestation/client/launch.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>

#include "basestation/client/connection.hpp"
#include "basestation/client/paths.hpp"
#include "core/command/words.hpp"
#include "core/wire/link_file.hpp"

namespace adit::station::client {
namespace {

constexpr int kReadyFd = 3;
constexpr int kStartLimitMs = 10000;
constexpr auto kHelloLimit = std::chrono::seconds(1);
constexpr int kHelloPollMs = 100;

std::vector<std::string> arguments(const StationOptions& options) {
  std::vector<std::string> words = program_words(options);
  if (!options.link.empty()) words.insert(words.end(), {"--link", options.link});
  if (!options.at.empty()) words.push_back("--at");
  for (const float metres : options.at) words.push_back(std::to_string(metres));
  if (!options.record.empty()) words.insert(words.end(), {"--record", options.record});
  words.insert(words.end(), {"--serve", std::to_string(kReadyFd)});
  return words;
}

/// Runs between fork and exec: calls only functions that are async-signal-safe.
[[noreturn]] void become_station(char* const* argv, int ready, int log) {
  ::setsid();
  if (::fork() != 0) ::_exit(0);  // The grandchild belongs to init, which reaps it.
  const int null = ::open("/dev/null", O_RDWR);
  ::dup2(null, 0);
  ::dup2(log >= 0 ? log : null, 1);
  ::dup2(log >= 0 ? log : null, 2);
  if (ready == kReadyFd)
    ::fcntl(ready, F_SETFD, 0);
  else
    ::dup2(ready, kReadyFd);
  ::close_range(kReadyFd + 1, ~0U, 0);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  ::execv(argv[0], argv);
  static constexpr char failed[] = "this program cannot be started again\n";
  (void)!::write(kReadyFd, failed, sizeof failed - 1);
  ::_exit(127);
}

/// Asks the station for its description. Nothing if it does not answer immediately.
std::optional<StationOptions> ask_hello(const std::string& path) {
  auto socket = LineSocket::connect(path);
  if (!socket) return std::nullopt;
  Connection connection(std::move(*socket), "hello");
  std::optional<StationOptions> running;
  connection.on_hello = [&](const StationOptions& options) { running = options; };
  connection.hello();
  const auto until = std::chrono::steady_clock::now() + kHelloLimit;
  while (!running && std::chrono::steady_clock::now() < until)
    if (!connection.wait(kHelloPollMs)) break;
  return running;
}

std::string text_of(std::vector<std::string> addresses) {
  std::erase(addresses, "127.0.0.1");
  std::sort(addresses.begin(), addresses.end());
  return command::joined(addresses, "loopback");
}

/// Checks the running station's network: on another domain or interface the command would reach other robots.
/// Returns a remark on options that have no effect, or nothing.
Result<std::string> check_running(const std::string& path, const StationOptions& options) {
  const bool asks = options.domain_given || !options.link.empty() || !options.interfaces.empty() ||
                    !options.peers.empty() || !options.at.empty() || !options.record.empty();
  if (!asks) return std::string();
  const std::optional<StationOptions> running = ask_hello(path);
  if (!running && (options.domain_given || !options.interfaces.empty()))
    return Error{
        Reason::no_answer,
        "the station of " + options.name +
            " does not say on which network it runs; leave --domain and --interface out, or try again"};
  if (!running) return std::string();
  const std::string station = "the station of " + options.name + " runs ";
  const auto misfit = [&](const std::string& where, const char* option) {
    return Error{Reason::bad_argument, station + "on " + where + "; leave " + option +
                                           " out, choose another --name, or end it: basestation --name " +
                                           options.name + " down"};
  };
  if (options.domain_given && running->domain != options.domain)
    return misfit("domain " + std::to_string(running->domain), "--domain");
  if (!options.interfaces.empty() && text_of(running->interfaces) != text_of(options.interfaces))
    return misfit(text_of(running->interfaces), "--interface");
  std::string remark;
  const auto has_no_effect = [&](const std::string& how, const char* option) {
    remark +=
        (remark.empty() ? "" : "\n") + station + how + "; " + option + " counts only when a station starts";
  };
  if (!options.link.empty() && running->link != options.link)
    has_no_effect(running->link.empty() ? "without a link profile" : "on " + running->link, "--link");
  if (!options.peers.empty() && running->peers != options.peers)
    has_no_effect(
        running->peers.empty() ? "without peers" : "with the peers " + command::joined(running->peers, ""),
        "--peer");
  if (!options.at.empty()) has_no_effect("already", "--at");
  if (!options.record.empty()) has_no_effect("already", "--record");
  return remark;
}

}  // namespace

std::vector<std::string> program_words(const StationOptions& options) {
  std::vector<std::string> words{options.program, "--name", options.name, "--domain",
                                 std::to_string(options.domain)};
  for (const std::string& address : options.interfaces) words.insert(words.end(), {"--interface", address});
  for (const std::string& peer : options.peers) words.insert(words.end(), {"--peer", peer});
  return words;
}

Result<void> launch(const StationOptions& options) {
  auto state = state_folder();
  if (!state) return state.error();
  const std::string log_path = *state + "/" + options.name + ".log";
  const File log(::open(log_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0)
    return {Reason::internal, std::string("no pipe: ") + std::strerror(errno)};
  File reading(ends[0]);
  File writing(ends[1]);

  std::vector<std::string> words = arguments(options);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child < 0) return {Reason::internal, std::string("cannot fork: ") + std::strerror(errno)};
  if (child == 0) become_station(argv.data(), writing.get(), log.get());
  writing.reset();
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }

  std::string text;
  for (;;) {
    pollfd readable{reading.get(), POLLIN, 0};
    const int ready = ::poll(&readable, 1, kStartLimitMs);
    if (ready < 0 && errno == EINTR) return {Reason::cancelled, "interrupted while the station starts"};
    if (ready <= 0) return {Reason::no_answer, "the station did not start within 10 s; see " + log_path};
    char buffer[512];
    const ssize_t size = ::read(reading.get(), buffer, sizeof buffer);
    if (size <= 0) break;
    text.append(buffer, static_cast<std::size_t>(size));
  }
  if (text == "ready\n") return {};
  while (text.ends_with('\n')) text.pop_back();
  return {Reason::no_station, text.empty() ? "the station ended while it started; see " + log_path : text};
}

Result<Connected> connect_or_launch(const StationOptions& options) {
  auto path = socket_path(options.name);
  if (!path) return path.error();
  auto socket = LineSocket::connect(*path);
  if (socket) {
    auto remark = check_running(*path, options);
    if (!remark) return remark.error();
    return Connected{std::move(*socket), std::move(*remark)};
  }
  if (socket.reason() != Reason::no_station) return socket.error();
  if (const auto link = wire::load_link(options.link.empty() ? "lan" : options.link); !link)
    return Error{Reason::bad_argument, "--link: " + link.error().text};
  const auto started = launch(options);
  socket = LineSocket::connect(*path);  // Another process may have started it at the same time.
  if (!socket) return started ? socket.error() : started.error();
  if (!started) return Connected{std::move(*socket), {}};
  return Connected{std::move(*socket), "no station of " + options.name +
                                           " was running: started one (end it with: basestation --name " +
                                           options.name + " down)"};
}

}  // namespace adit::station::client
