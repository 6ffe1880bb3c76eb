#pragma once
#include <memory>
#include <string>

#include "core/exec/executor.hpp"
#include "core/result/result.hpp"
#include "core/wire/participant.hpp"
#include "robot_agent/common/notice.hpp"

namespace adit::agent {

/// Sends notifications, from any strand, numbers them and says when they arose. A failed write is counted by
/// the wire. Bound to no component: the supervisor still speaks by it when one was revoked.
class Notifier {
 public:
  /// `clock`: asked for the time alone, from any thread; it outlives this. Errors of the wire.
  static Result<std::unique_ptr<Notifier>> open(wire::Participant& radio, const std::string& robot,
                                                const Executor& clock);
  ~Notifier();
  Notifier(const Notifier&) = delete;
  Notifier& operator=(const Notifier&) = delete;

  void send(const Notice& notice);
  /// The same for who must not wait: false, and nothing sent, while another strand is sending. It may hang.
  bool try_send(const Notice& notice);

 private:
  Notifier();
  struct Endpoint;
  std::unique_ptr<Endpoint> endpoint_;
};

}  // namespace adit::agent
