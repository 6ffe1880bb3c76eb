#include "robot_agent/state/restored.hpp"

namespace adit::agent {
namespace {

constexpr store::StateFormat kIdentityFormat{{'I', 'D', 'E', 'N'}, 1, 16};

}  // namespace

Restored restore_state(const std::shared_ptr<store::Disk>& disk) {
  if (!disk) return {};
  const store::State state = store::StateFile(disk, kStateFile, kSnapshotFormat).load();
  switch (state.found) {
    case store::Found::nothing: {
      const auto marker = disk->read(kMarkerFile);
      if (!marker || *marker) return {std::nullopt, true, "the disk could not keep it", 0};
      return {};
    }
    case store::Found::good: {
      auto snapshot = decode_snapshot(state.payload);
      if (!snapshot) return {std::nullopt, true, "corrupt: it makes no sense", state.generation};
      return {std::move(snapshot), false, {}, state.generation};
    }
    default:
      return {std::nullopt, true, std::string(store::name(state.found)) + ": " + state.text, 0};
  }
}

Id restore_identity(const std::shared_ptr<store::Disk>& disk, const Id& drawn) {
  if (!disk) return drawn;
  const store::StateFile file(disk, kIdentityFile, kIdentityFormat);
  const store::State state = file.load();
  if (state.found == store::Found::good && state.payload.size() == drawn.size()) {
    Id id{};
    std::copy(state.payload.begin(), state.payload.end(), id.begin());
    return id;
  }
  (void)file.save(1, drawn);  // a disk that fails is reported with the first state
  return drawn;
}

std::string describe(const Snapshot& s) {
  std::string text = s.authority.holder ? "held by " + s.authority.holder->name : "held by nobody";
  if (s.authority.locked) text += ", locked";
  for (std::size_t i = 0; i < s.authority.stops.size(); ++i)
    text += (i == 0 ? "; stopped by " : ", ") + s.authority.stops[i].name;
  text += "; was in " + s.behaviour.mode;
  if (s.behaviour.goal_known) text += ", goal " + std::to_string(s.behaviour.goal_id) + " kept";
  return text;
}

}  // namespace adit::agent
