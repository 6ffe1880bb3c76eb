// SPDX-License-Identifier: Apache-2.0
#include "tests/hosts/hosts.hpp"

#include <stdexcept>

#include "tests/folders/folders.hpp"

namespace adit::hosts {
namespace {

using live::Process;
using live::Seconds;

// Ends with the test, even when that is killed.
const std::vector<std::string> kWithUs{"/usr/bin/env", "setpriv", "--pdeathsig", "KILL"};

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<std::string> entering(const Process& holder) {
  return {"nsenter", "--target", std::to_string(holder.pid()), "--net", "--"};
}

}  // namespace

std::unique_ptr<Process> Hosts::hold() {
  auto holder = std::make_unique<Process>(joined(
      kWithUs, {"unshare", "--net", "sh", "-c", "ip link set lo up && echo ready && exec sleep infinity"}));
  if (!holder->wait_for_output("ready", Seconds(5)))
    throw std::runtime_error("no network namespace: " + holder->err());
  return holder;
}

std::string Hosts::refused() {
  try {
    Hosts hosts;
    hosts.add("a", "10.77.0.1");
    hosts.shape("a", 500);
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

Hosts::Hosts() : bridge_(hold()) {
  in(*bridge_, {"ip", "link", "add", "name", "br0", "type", "bridge", "mcast_snooping", "0"});
  in(*bridge_, {"ip", "link", "set", "dev", "br0", "up"});
}

void Hosts::in(const Process& holder, std::vector<std::string> words) const {
  const auto done = live::run(joined({"/usr/bin/env"}, joined(entering(holder), words)), {}, Seconds(5));
  if (done.exit_code == 0) return;
  std::string line;
  for (const std::string& word : words) line += word + " ";
  throw std::runtime_error(line + "failed: " + done.err);
}

void Hosts::add(const std::string& host, const std::string& address) {
  Host& own = hosts_[host];
  own.holder = hold();
  own.address = address;
  in(*bridge_, {"ip", "link", "add", "name", host, "type", "veth", "peer", "name", "eth0", "netns",
                std::to_string(own.holder->pid())});
  in(*bridge_, {"ip", "link", "set", "dev", host, "master", "br0", "up"});
  in(*own.holder, {"ip", "address", "add", address + "/24", "dev", "eth0"});
  in(*own.holder, {"ip", "link", "set", "dev", "eth0", "up"});
}

void Hosts::readdress(const std::string& host, const std::string& address) {
  Host& own = hosts_.at(host);
  in(*own.holder, {"ip", "address", "flush", "dev", "eth0"});
  in(*own.holder, {"ip", "address", "add", address + "/24", "dev", "eth0"});
  own.address = address;
}

void Hosts::shape(const std::string& host, int kbit, int queue_ms) {
  const auto shaped = [&](const Process& where, const std::string& device) {
    in(where, {"tc", "qdisc", "replace", "dev", device, "root", "tbf", "rate", std::to_string(kbit) + "kbit",
               "burst", "3000", "latency", std::to_string(queue_ms) + "ms"});
  };
  shaped(*hosts_.at(host).holder, "eth0");
  shaped(*bridge_, host);
}

void Hosts::link(const std::string& host, bool up) {
  in(*hosts_.at(host).holder, {"ip", "link", "set", "dev", "eth0", up ? "up" : "down"});
}

Process Hosts::start(const std::string& host, std::vector<std::string> words,
                     std::map<std::string, std::string> environment) const {
  if (words[0].find('/') == std::string::npos) words[0] = program_folder() + "/" + words[0];
  return Process(joined(kWithUs, joined(entering(*hosts_.at(host).holder), words)), std::move(environment));
}

}  // namespace adit::hosts
