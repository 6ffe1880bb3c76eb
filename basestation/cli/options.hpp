#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace adit::station::cli {

/// What stands before the command on the command line.
struct Options {
  std::string name{"op1"};  ///< the operator's
  std::string link{};  ///< profile of config/links, or a .yaml file, that what is sent keeps to; empty: none
  bool json{false};
  std::uint32_t domain{77};               ///< radio domain, [0, 232]
  bool domain_given{false};               ///< a station that runs must be on `domain`
  std::vector<std::string> interfaces{};  ///< addresses; none: loopback
  std::vector<std::string> peers{};       ///< for networks without multicast
  std::vector<float> at{};                ///< X Y Z of the station, map frame, m; empty: not known
  std::string record{};                   ///< folder of recordings, "none"; empty: below the state folder
  std::string program{};                  ///< path of this program, to start a station with
};

/// Exit codes of the program.
inline constexpr int kExitDone = 0;
inline constexpr int kExitRefused = 1;
inline constexpr int kExitUsage = 2;
inline constexpr int kExitNoAnswer = 3;

}  // namespace adit::station::cli
