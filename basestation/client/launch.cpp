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
#include <nlohmann/json.hpp>

#include "basestation/client/paths.hpp"
#include "core/command/words.hpp"
#include "core/wire/link_file.hpp"

namespace adit::station::client {
namespace {

constexpr int kReadyFd = 3;
constexpr int kStartLimitMs = 10000;
constexpr int kHelloLimitMs = 1000;

std::vector<std::string> arguments(const StationOptions& options) {
  std::vector<std::string> words{options.program, "--name", options.name, "--domain",
                                 std::to_string(options.domain)};
  if (!options.link.empty()) words.insert(words.end(), {"--link", options.link});
  for (const std::string& address : options.interfaces) words.insert(words.end(), {"--interface", address});
  for (const std::string& peer : options.peers) words.insert(words.end(), {"--peer", peer});
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

/// Asks the station for its description; null if it does not answer immediately, which the command itself
/// then reports.
nlohmann::json ask_hello(LineSocket& socket) {
  if (!socket.send_line(R"({"hello": true})")) return {};
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(kHelloLimitMs);
  for (;;) {
    // Events of other programs' commands may come first.
    while (const auto line = socket.line()) {
      const auto answer = nlohmann::json::parse(*line, nullptr, false);
      if (answer.is_object() && answer.contains("hello") && answer["hello"].is_object())
        return answer["hello"];
    }
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    pollfd readable{socket.fd(), POLLIN, 0};
    if (left.count() <= 0 || ::poll(&readable, 1, static_cast<int>(left.count())) <= 0 || !socket.pump())
      return {};
  }
}

std::string text_of(std::vector<std::string> addresses) {
  std::erase(addresses, "127.0.0.1");
  std::sort(addresses.begin(), addresses.end());
  return command::joined(addresses, "loopback");
}

/// Checks the running station's network: on another domain or interface the command would reach other robots.
/// Returns a remark on options that have no effect, or nothing.
Result<std::string> check_running(LineSocket& socket, const StationOptions& options) {
  const bool asks = options.domain_given || !options.link.empty() || !options.interfaces.empty() ||
                    !options.peers.empty() || !options.at.empty() || !options.record.empty();
  if (!asks) return std::string();
  const nlohmann::json hello = ask_hello(socket);
  if (hello.is_null()) return std::string();
  const auto domain = hello.value("domain", options.domain);
  if (options.domain_given && domain != options.domain)
    return Error{Reason::bad_argument,
                 "the station of " + options.name + " runs on domain " + std::to_string(domain) +
                     "; leave --domain out, choose another --name, or end it: basestation --name " +
                     options.name + " down"};
  const std::string running = text_of(hello.value("interfaces", options.interfaces));
  if (!options.interfaces.empty() && running != text_of(options.interfaces))
    return Error{Reason::bad_argument,
                 "the station of " + options.name + " runs on " + running +
                     "; leave --interface out, choose another --name, or end it: basestation --name " +
                     options.name + " down"};
  std::string remark;
  const auto has_no_effect = [&](const std::string& how, const char* option) {
    remark += (remark.empty() ? "" : "\n") + ("the station of " + options.name) + " runs " + how + "; " +
              option + " counts only when a station starts";
  };
  const auto link = hello.value("link", options.link);
  if (!options.link.empty() && link != options.link)
    has_no_effect(link.empty() ? "without a link profile" : "on " + link, "--link");
  const auto peers = hello.value("peers", options.peers);
  if (!options.peers.empty() && peers != options.peers)
    has_no_effect(peers.empty() ? "without peers" : "with the peers " + command::joined(peers, ""), "--peer");
  if (!options.at.empty()) has_no_effect("already", "--at");
  if (!options.record.empty()) has_no_effect("already", "--record");
  return remark;
}

}  // namespace

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
    auto remark = check_running(*socket, options);
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
