// SPDX-License-Identifier: Apache-2.0
#include "basestation/findings/photo_desk.hpp"

namespace adit::station {

PhotoDesk::PhotoDesk(const FindingDesk& findings, std::shared_ptr<store::Disk> disk, Executor& home,
                     Trouble trouble, std::function<void()> changed)
    : findings_(findings),
      photos_({.max_bytes = kMaxBytes}, std::move(disk), home, nullptr,
              {[trouble](bool failing, const std::string& text) {
                 trouble(failing ? "store_failing" : "store_works", text);
               },
               [trouble](const std::string& text) { trouble("findings_full", text); },
               [changed](std::uint64_t, findings::PhotoPart) { changed(); }}) {}

const findings::Finding* PhotoDesk::finding_of(const std::string& sender,
                                               const std::optional<findings::Owner>& station,
                                               std::uint64_t content) const {
  const auto& all = findings_.all();
  for (auto at = all.lower_bound({sender, 0}); at != all.end() && at->first.robot == sender; ++at)
    if (at->second.photo && at->second.photo->content == content &&
        findings::marked_by(at->second) == station)
      return &at->second;
  return nullptr;
}

Result<void> PhotoDesk::hear(const std::string& sender, const std::optional<findings::Owner>& station,
                             std::span<const std::uint8_t> bytes, std::function<void()> stored) {
  const auto piece = findings::decode_photo_piece(bytes);
  if (!piece) return piece.error();
  const findings::Finding* finding = finding_of(sender, station, piece->content);
  if (finding == nullptr) return {Reason::malformed, "a photo of no finding that is here"};
  return photos_.add(*piece, *finding->photo, finding->importance, sender, std::move(stored));
}

}  // namespace adit::station
