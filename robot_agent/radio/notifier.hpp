#pragma once
#include <memory>
#include <string>

#include "core/result/result.hpp"
#include "core/wire/wire.hpp"
#include "robot_agent/command/types.hpp"

namespace adit::agent {

/// Sends notifications, from any strand, and numbers them. Never waits for a strand that hangs: who finds
/// the writer in use for long is told that nothing was sent.
class Notifier {
 public:
  /// Errors of the wire.
  static Result<std::unique_ptr<Notifier>> open(wire::Wire& radio, const std::string& robot);
  ~Notifier();
  Notifier(const Notifier&) = delete;
  Notifier& operator=(const Notifier&) = delete;

  /// False when another strand was writing for more than 20 ms. A failed write is counted by the wire.
  bool send(const Notice& notice);

 private:
  Notifier();
  struct Endpoint;
  std::unique_ptr<Endpoint> endpoint_;
};

}  // namespace adit::agent
