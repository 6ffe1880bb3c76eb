// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/wire/forwarding_participant.hpp"

namespace adit::bench {

/// Passes everything on to another wire and calls `before` and `after` around each write of one topic.
class TappedWire final : public wire::ForwardingParticipant {
 public:
  using Tap = std::function<void(std::span<const std::uint8_t>)>;
  TappedWire(wire::Participant& inner, std::string topic, Tap before, Tap after)
      : ForwardingParticipant(inner),
        topic_(std::move(topic)),
        before_(std::move(before)),
        after_(std::move(after)) {}

  Result<std::unique_ptr<wire::RawWriter>> make_writer(const wire::TopicInfo& topic,
                                                       const std::string& partition) override {
    auto made = inner_.make_writer(topic, partition);
    if (!made || topic_ != topic.name) return made;
    return std::unique_ptr<wire::RawWriter>(new TappedWriter(std::move(*made), *this));
  }

 private:
  class TappedWriter final : public wire::RawWriter {
   public:
    TappedWriter(std::unique_ptr<wire::RawWriter> inner, TappedWire& owner)
        : inner_(std::move(inner)), owner_(owner) {}
    Result<void> write(std::span<const std::uint8_t> cdr) override {
      if (owner_.before_) owner_.before_(cdr);
      auto result = inner_->write(cdr);
      if (owner_.after_) owner_.after_(cdr);
      return result;
    }
    std::size_t matched() const override { return inner_->matched(); }

   private:
    std::unique_ptr<wire::RawWriter> inner_;
    TappedWire& owner_;
  };

  std::string topic_;
  Tap before_, after_;
};

}  // namespace adit::bench
