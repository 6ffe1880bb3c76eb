#pragma once
#include <memory>

#include "core/wire/forwarding_wire.hpp"
#include "sim/defects/interceptor.hpp"

namespace adit::sim {

/// A wire whose samples pass an interceptor in both directions.
class InterceptedWire final : public wire::ForwardingWire {
 public:
  /// Both must outlive this, its readers and its writers.
  InterceptedWire(wire::Wire& inner, Interceptor& interceptor);
  ~InterceptedWire() override;

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
