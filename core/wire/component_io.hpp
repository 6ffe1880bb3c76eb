// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "core/wire/typed.hpp"

namespace adit::wire {

/// Opens the writers and readers of a component that can be restarted. They work while `generation` is valid;
/// afterwards nothing is written and no handler is called.
struct ComponentIo {
  Participant& wire;                               ///< Must outlive the writers and readers.
  Executor& strand;                                ///< Handlers run on it.
  std::shared_ptr<const Generation> generation{};  ///< Null: the component is never replaced.

  bool valid() const { return !generation || generation->valid(); }

  /// Errors are those of Participant. An empty `partition` means the default one.
  template <class T>
  Result<void> open(Writer<T>& writer, const Topic<T>& topic, const std::string& partition = {}) const {
    auto made = Writer<T>::make(wire, topic, partition);
    if (!made) return made.error();
    writer = std::move(*made);
    writer.bind(generation);
    return {};
  }
  /// Calls `handler(const T&, const SampleInfo&)` for each sample until the reader is destroyed.
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
