// SPDX-License-Identifier: Apache-2.0
#include <zstd.h>

#include <sstream>

#include "bench/map_link/rule.hpp"
#include "perception/map/export/octree_file.hpp"

namespace adit::bench {

std::size_t octree_file_bytes(const std::vector<perception::CoarseBlock>& blocks) {
  perception::VoxelImage image(0.2);
  image.add(Pose3{}, blocks);
  std::ostringstream file;
  if (image.empty() || !perception::write_bt(image, file)) return 0;
  const std::string text = file.str();
  std::vector<std::uint8_t> out(ZSTD_compressBound(text.size()));
  return ZSTD_compress(out.data(), out.size(), text.data(), text.size(), 19);
}

void Account::add(const Account& other) {
  content += other.content;
  first += other.first;
  coarse += other.coarse;
  changed += other.changed;
  repeated += other.repeated;
  poses += other.poses;
  lost += other.lost;
  sent += other.sent;
  held += other.held;
  paced += other.paced;
  ticks += other.ticks;
}

}  // namespace adit::bench
