// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "core/wire/forwarding_participant.hpp"
#include "sim/defects/interceptor.hpp"

namespace adit::sim {

/// A wire whose samples pass an interceptor in both directions.
class InterceptedParticipant final : public wire::ForwardingParticipant {
 public:
  /// Both must outlive this, its readers and its writers.
  InterceptedParticipant(wire::Participant& inner, Interceptor& interceptor);
  ~InterceptedParticipant() override;

  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override;
  Result<std::unique_ptr<wire::RawReader>> make_reader(const wire::TopicInfo& topic,
                                                       const std::string& partition, Executor& strand,
                                                       wire::RawHandler handler) override;

 private:
  struct Readers;
  Interceptor& interceptor_;
  std::shared_ptr<Readers> readers_;
};

}  // namespace adit::sim
