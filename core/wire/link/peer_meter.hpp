#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/time/time.hpp"

namespace adit::wire {

/// What a link to each peer gives, measured on the signs of life that everybody sends: loss by the gaps in a
/// peer's numbers, the round trip by what a peer's report echoes. Own clock alone; bounded.
class PeerMeter {
 public:
  static constexpr std::size_t kMaxPeers = 64;
  static constexpr std::uint32_t kWindow = 32;  ///< signs of life that the share lost is taken over

  struct Peer {
    std::string name{};
    std::uint32_t number{};              ///< of the newest sign of life that was heard
    Duration held{};                     ///< since then
    float lost{};                        ///< share of its signs of life, [0, 1]
    std::optional<double> round_trip{};  ///< s
  };

  /// An own sign of life went out under that number.
  void sent(std::uint32_t number, Time now);
  /// A peer's sign of life was heard. A number that went back: the peer began anew.
  void heard(const std::string& name, std::uint32_t number, Time now);
  /// A peer's report says that the newest own sign of life it heard was `number`, `held` ago.
  void echoed(const std::string& name, std::uint32_t number, Duration held, Time now);
  /// Of one peer, or all, by name.
  std::optional<Peer> peer(const std::string& name, Time now) const;
  std::vector<Peer> peers(Time now) const;
  void forget(const std::string& name) { heard_.erase(name); }

 private:
  struct Heard {
    std::uint32_t number{};
    Time at{};
    std::uint32_t bits{};   // which of the last `kWindow` numbers were heard, the newest lowest
    std::uint32_t known{};  // numbers that `bits` tells of, at most `kWindow`
    std::optional<double> round_trip{};
  };
  static Peer view(const std::string& name, const Heard& heard, Time now);

  std::map<std::string, Heard> heard_{};
  std::array<std::pair<std::uint32_t, Time>, kWindow> sent_{};  // by number
};

}  // namespace adit::wire
