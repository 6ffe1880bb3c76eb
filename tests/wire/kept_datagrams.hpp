// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace adit::wire::test {

/// The inputs that the fuzzer of the guard found worth keeping, as tools/keep_corpus.sh packs them: of each
/// its length in six digits, then its bytes.
inline std::vector<std::vector<std::uint8_t>> kept_datagrams(const std::string& file) {
  std::vector<std::vector<std::uint8_t>> all;
  std::ifstream in(file, std::ios::binary);
  std::string length(6, '0');
  while (in.read(length.data(), 6)) {
    std::vector<std::uint8_t> bytes(std::stoul(length));
    if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) break;
    all.push_back(std::move(bytes));
  }
  return all;
}

}  // namespace adit::wire::test
