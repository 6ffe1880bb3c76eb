#pragma once
#include <memory>
#include <string>

#include "core/wire/typed.hpp"

namespace adit::wire {

/// The one place where a component that can be replaced opens its writers and readers. All of them work while
/// `generation` is valid: afterwards nothing is written, and no handler is called.
struct ComponentIo {
  Participant& wire;                               ///< Must outlive the writers and readers.
  Executor& strand;                                ///< Handlers run on it.
  std::shared_ptr<const Generation> generation{};  ///< Null: the component is never replaced.

  bool valid() const { return !generation || generation->valid(); }

  /// Errors are the wire's. `partition` empty: the default one.
  template <class T>
  Result<void> open(Writer<T>& writer, const Topic<T>& topic, const std::string& partition = {}) const {
    auto made = Writer<T>::make(wire, topic, partition);
    if (!made) return made.error();
    writer = std::move(*made);
    writer.bind(generation);
    return {};
  }
  /// `handler(const T&, const SampleInfo&)` runs until the reader goes.
  template <class T, class Handler>
  Result<void> open(std::unique_ptr<RawReader>& reader, const Topic<T>& topic, Handler handler,
                    const std::string& partition = {}) const {
    auto made = make_reader(wire, topic, strand, std::move(handler), partition, generation);
    if (!made) return made.error();
    reader = std::move(*made);
    return {};
  }
};

}  // namespace adit::wire
