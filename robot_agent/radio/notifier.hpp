// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "core/exec/executor.hpp"
#include "core/result/result.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/notice.hpp"

namespace adit::agent {

/// Sends notifications from any strand, with a number and the time of the event. The participant counts
/// failed writes. It belongs to no component: the supervisor uses it even when a component was revoked.
class Notifier {
 public:
  /// `clock` only provides the time, from any thread, and must outlive this. Errors: those of the
  /// participant.
  static Result<std::unique_ptr<Notifier>> open(wire::Participant& radio, const std::string& robot,
                                                const Executor& clock);
  ~Notifier();
  Notifier(const Notifier&) = delete;
  Notifier& operator=(const Notifier&) = delete;

  void send(const Notice& notice);
  void to_all(Severity severity, const std::string& code, Reason reason, const std::string& text) {
    send({{}, severity, code, reason, text});
  }
  /// As send(), but never blocks: returns false and sends nothing while another strand, which may hang, is
  /// sending.
  bool try_send(const Notice& notice);

 private:
  Notifier();
  struct Endpoint;
  std::unique_ptr<Endpoint> endpoint_;
};

}  // namespace adit::agent
