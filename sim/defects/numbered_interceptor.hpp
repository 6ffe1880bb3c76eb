// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string_view>
#include <tuple>

#include "sim/defects/radio_interceptor.hpp"

namespace adit::sim {

/// An interceptor that can give the agent commands of its own, in the holder's name. It spaces the numbers of
/// commands so that its own fit between them, and takes the spacing out of the answers.
class NumberedInterceptor : public RadioInterceptor {
 public:
  using RadioInterceptor::RadioInterceptor;

 protected:
  static constexpr std::uint64_t kSpacing = 8;

  /// Hands the command on under its own number.
  void pass(CommandFrom command, std::vector<Arrival>& out);
  /// Hands the command on under a number that was never used; its answer gets the command's number back.
  void pass_as_new(CommandFrom command, std::vector<Arrival>& out);
  /// Hands the command on as if the holder had sent it; the answer goes to who sent it. Nothing changes while
  /// the robot has no holder.
  void pass_as_holders(const CommandFrom& command, std::vector<Arrival>& out);
  /// Gives a command in the holder's name; its answer goes to no station. Does nothing without a holder of
  /// the robot.
  void give(radio::CommandKind kind, std::vector<Arrival>& out, std::string_view word = {},
            std::uint16_t options = 0);

  void on_command(const CommandFrom& command, std::vector<Arrival>& out) override { pass(command, out); }
  bool on_answer(radio::Acknowledgement& answer) override;

 private:
  /// The station that asked and its sequence number; 0: none.
  struct Asked {
    std::string station{};
    StationId id{};
    std::uint64_t seq{};
  };
  std::uint64_t next(const wire::ParticipantId& participant);

  std::map<wire::ParticipantId, std::uint64_t> newest_{};
  std::map<std::pair<StationId, std::uint64_t>, Asked> asked_{};  ///< By the number that the agent sees.
  /// Commands of strangers that were handed on as the holder's: a repeat has the same number.
  std::map<std::pair<wire::ParticipantId, std::uint64_t>, CommandFrom> strangers_{};
};

}  // namespace adit::sim
