// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "adit/common.h"
#include "core/command/words.hpp"
#include "core/time/random.hpp"
#include "core/wire/typed.hpp"

namespace adit::contract {

/// Random samples of generated types as any peer could send them: unknown enumerators, numbers at their
/// limits or not finite, texts that are empty, too long or full of control characters, lists of any length.
class RandomSamples {
 public:
  explicit RandomSamples(std::uint64_t seed) : random_(seed) {}

  Random& random() { return random_; }

  /// A finite number in [-limit, limit], sometimes 0 or at a limit.
  double number(double limit) {
    const std::array special{0.0, limit, -limit};
    return random_.chance(0.2) ? special[random_.below(special.size())] : random_.uniform(-limit, limit);
  }

  /// A name that may be sent: 1 to 32 of [A-Za-z0-9_-].
  std::string name() {
    constexpr std::string_view kLetters = "abcXYZ019_-";
    std::string out(1 + random_.below(32), '\0');
    for (char& c : out) c = kLetters[random_.below(kLetters.size())];
    return out;
  }

  /// Any text: a name, or up to 300 bytes of any value.
  std::string text() {
    if (random_.chance(0.5)) return name();
    std::string out(random_.below(random_.chance(0.5) ? 4 : 300), '\0');
    for (char& c : out) c = static_cast<char>(random_.next());
    return out;
  }

  template <class T>
  void any(T& out) {
    if constexpr (std::is_same_v<T, bool>)
      out = random_.chance(0.5);
    else if constexpr (std::is_floating_point_v<T>)
      out = any_real<T>();
    else if constexpr (std::is_integral_v<T>)
      out = any_integer<T>();
    else if constexpr (std::is_enum_v<T>)
      out = static_cast<T>(random_.chance(0.8) ? random_.below(8) : random_.next() & 0xffffffffU);
    else if constexpr (std::is_same_v<T, std::string>)
      out = text();
    else
      randomize(*this, out);  // A type of idl/adit/: its members.
  }
  template <class T, std::size_t N>
  void any(std::array<T, N>& out) {
    for (T& element : out) any(element);
  }
  /// Often a few elements, sometimes none, sometimes more than any bound of the contract for such a list.
  template <class T>
  void any(std::vector<T>& out) {
    out.resize(random_.below(random_.chance(0.2) ? 140 : 4));
    for (T& element : out) any(element);
  }
  template <class First, class Second, class... Others>
  void any(First& first, Second& second, Others&... others) {
    any(first);
    any(second, others...);
  }

 private:
  template <class T>
  T any_real() {
    using Limits = std::numeric_limits<T>;
    constexpr std::array kSpecial{T(0),
                                  T(1),
                                  Limits::quiet_NaN(),
                                  Limits::infinity(),
                                  -Limits::infinity(),
                                  Limits::max(),
                                  Limits::lowest(),
                                  Limits::denorm_min()};
    if (random_.chance(0.1)) return kSpecial[random_.below(kSpecial.size())];
    return static_cast<T>(number(random_.chance(0.5) ? 10.0 : 1e6));
  }
  template <class T>
  T any_integer() {
    constexpr std::array kSpecial{T(0), T(1), std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
    return random_.chance(0.3) ? kSpecial[random_.below(kSpecial.size())] : static_cast<T>(random_.next());
  }

  Random random_;
};

inline void randomize(RandomSamples& random, radio::Epoch& out) { random.any(out.start(), out.counter()); }

/// Whether a text is printable ASCII of at most `max` bytes.
inline bool is_clean(const std::string& text, std::size_t max) {
  return text.size() <= max && command::clean(text, max) == text;
}

/// The bytes of a sample as they are sent.
template <class T>
std::vector<std::uint8_t> serialised(const T& sample) {
  std::vector<std::uint8_t> bytes;
  wire::encode(sample, bytes);
  return bytes;
}

/// The sample after serialisation and deserialisation.
template <class T>
T through_cdr(const T& sample) {
  T out;
  EXPECT_TRUE(wire::decode(serialised(sample), out));
  return out;
}

/// The same, of a message that must fit its topic.
template <class T>
T through_cdr(const T& sample, const wire::TopicInfo& topic) {
  EXPECT_LE(4 + T::getCdrSerializedSize(sample), topic.max_bytes);
  return through_cdr(sample);
}

inline constexpr std::uint64_t kSeeds = 300;

/// Calls `check(sample)` with random samples that went through serialisation; none may throw.
template <class T, class Check>
void for_any(const Check& check) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomSamples random(seed);
    T sample;
    random.any(sample);
    EXPECT_NO_THROW(check(through_cdr(sample)));
  }
}

/// Calls `check(random)` for each seed, to make a value and compare it with what comes back.
template <class Check>
void for_each_seed(const Check& check) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    RandomSamples random(seed);
    check(random);
  }
}

}  // namespace adit::contract
