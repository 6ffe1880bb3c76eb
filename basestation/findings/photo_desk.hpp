// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "basestation/findings/desk.hpp"
#include "core/findings/photo_store.hpp"

namespace adit::station {

/// The photos of all findings on this station's disk, as their pieces come by radio. A piece is used only if
/// a finding that is here, of the same robot or station, names its photo and its size; it is acknowledged
/// once it is on the disk.
class PhotoDesk {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;  ///< Of all photos.
  /// `code`: findings_full or store_failing, store_works.
  using Trouble = std::function<void(const std::string& code, const std::string& text)>;

  /// `findings` must outlive it.
  /// `changed` is called when a thumbnail or a photo has become complete.
  PhotoDesk(const FindingDesk& findings, std::shared_ptr<store::Disk> disk, Executor& home, Trouble trouble,
            std::function<void()> changed);

  /// Loads the photos; a text for operators, or nothing.
  std::string load() { return photos_.load(); }
  /// Takes a piece of a photo of a robot, or with `station` of another station's mark. Errors: those of
  /// findings::decode_photo_piece() and findings::PhotoStore::add(); malformed for a photo of no finding
  /// here.
  Result<void> hear(const std::string& sender, const std::optional<findings::Owner>& station,
                    std::span<const std::uint8_t> bytes, std::function<void()> stored);

  findings::PhotoStore& photos() { return photos_; }
  const findings::PhotoStore& photos() const { return photos_; }

 private:
  const findings::Finding* finding_of(const std::string& sender,
                                      const std::optional<findings::Owner>& station,
                                      std::uint64_t content) const;

  const FindingDesk& findings_;
  findings::PhotoStore photos_;
};

}  // namespace adit::station
