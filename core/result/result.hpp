// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "core/result/reason.hpp"

namespace adit {

/// A failure that crosses a boundary: its reason, and a sentence that says what to do.
struct Error {
  Reason reason{Reason::internal};
  std::string text{};
};

/// A value or an Error. Accessing the absent alternative is a programming error (it throws
/// std::bad_variant_access, which no caller should catch).
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}
  Result(Reason reason, std::string text) : Result(Error{reason, std::move(text)}) {}

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }
  const Error& error() const { return std::get<1>(state_); }
  Reason reason() const { return ok() ? Reason::none : error().reason; }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}
  Result(Reason reason, std::string text) : error_(Error{reason, std::move(text)}) {}

  bool ok() const { return !error_; }
  explicit operator bool() const { return ok(); }
  const Error& error() const { return error_.value(); }
  Reason reason() const { return ok() ? Reason::none : error_->reason; }

 private:
  std::optional<Error> error_{};
};

}  // namespace adit
