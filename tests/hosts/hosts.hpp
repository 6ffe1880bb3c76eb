// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/live/process.hpp"

namespace adit::hosts {

/// Several machines with addresses of their own: network namespaces, each with an eth0 on a bridge that has a
/// namespace to itself. They live with processes that end with the test, whatever becomes of it, so nothing
/// stays behind; and nothing that is sent in them leaves the machine.
class Hosts {
 public:
  /// Why there can be none here; empty: there can.
  static std::string refused();
  Hosts();
  /// `address`: "10.77.0.1", in a network of 24 bits.
  void add(const std::string& host, const std::string& address);
  const std::string& address(const std::string& host) const { return hosts_.at(host).address; }
  void readdress(const std::string& host, const std::string& address);
  /// What the host sends and what is sent to it, by a token bucket with a queue of so many milliseconds.
  void shape(const std::string& host, int kbit, int queue_ms = 100);
  /// Pulls the cable, or plugs it in.
  void link(const std::string& host, bool up);
  /// Lets a program run there.
  live::Process start(const std::string& host, std::vector<std::string> words,
                      std::map<std::string, std::string> environment) const;

 private:
  struct Host {
    std::unique_ptr<live::Process> holder{};
    std::string address{};
  };
  /// A command of `ip` or `tc` in that host's namespace. Throws when it fails.
  void in(const live::Process& holder, std::vector<std::string> words) const;
  static std::unique_ptr<live::Process> hold();

  std::unique_ptr<live::Process> bridge_{};
  std::map<std::string, Host> hosts_{};
};

}  // namespace adit::hosts
