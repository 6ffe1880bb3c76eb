// SPDX-License-Identifier: Apache-2.0
#include "sim/defects/disk_filter.hpp"

namespace adit::sim {

Result<std::optional<store::Bytes>> DiskFilter::read_file(const std::string& name,
                                                          std::size_t max_bytes) const {
  return on_read(name, max_bytes);
}

Result<void> DiskFilter::write_file(const std::string& name, std::span<const std::uint8_t> bytes,
                                    bool append) {
  if (append) return inner_->append(name, bytes);
  if (!store::is_temporary(name)) return on_replace(name, {bytes.begin(), bytes.end()});
  temporary_[name] = {bytes.begin(), bytes.end()};
  return {};
}

Result<void> DiskFilter::rename_file(const std::string& from, const std::string& to) {
  const auto written = temporary_.find(from);
  if (written == temporary_.end()) return inner_->rename(from, to);
  const store::Bytes bytes = std::move(written->second);
  temporary_.erase(written);
  return on_replace(to, bytes);
}

Result<void> DiskFilter::remove_file(const std::string& name) {
  if (temporary_.erase(name) > 0) return {};
  return inner_->remove(name);
}

}  // namespace adit::sim
