// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "basestation/commands/outcome.hpp"
#include "basestation/send/answer.hpp"

namespace adit::station {

/// Collects the answers of robots to one command line.
class Gather {
 public:
  using Done = std::function<void(const Gather&)>;

  /// `done` is called once: when close() was called and every robot has answered.
  Gather(command::Request request, Done done);

  /// Expects one more answer, and returns its index.
  std::size_t expect(const std::string& robot);
  void take(std::size_t index, Answer answer);
  /// Expects no further robots.
  void close();

  const command::Request& request() const { return request_; }
  /// In the order of expect().
  const std::vector<Answer>& answers() const { return answers_; }
  bool expects(const std::string& robot) const;
  /// The answers as text and as JSON. `own_name`: the operator, who is not named as a robot's holder.
  Outcome outcome(const std::string& own_name) const;

 private:
  void finish();

  command::Request request_;
  Done done_;
  std::vector<Answer> answers_{};
  std::size_t missing_{1};  ///< Answers, and the call of close().
};

}  // namespace adit::station
