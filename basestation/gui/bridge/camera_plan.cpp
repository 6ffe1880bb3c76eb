// SPDX-License-Identifier: Apache-2.0
#include "basestation/gui/bridge/camera_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "basestation/model/text.hpp"

namespace adit::gui {
namespace {

constexpr double kPictureShare = 0.29;    // Of a link's bandwidth, as robots use it (agent::CameraParams).
constexpr double kThumbnailShare = 0.25;  // Of that.
constexpr double kSmallBits = 8.0 * 1000, kWideBits = 8.0 * 3200;  // Of a picture (perception::Ladder).
constexpr std::uint16_t kSmallWidth = 80, kWideWidth = 160;        // Pixels.
constexpr double kMinRate = 0.1, kMaxRate = 2.0;                   // Of thumbnails, 1/s.
constexpr double kWideRate = 0.5;   // The rate from which the wider thumbnail is worth its bytes, 1/s.
constexpr double kAmpleRoom = 2e6;  // For two cameras of a robot at once, bit/s.
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr float kSharpRate = 15.0F;  // 1/s

/// What a link leaves for pictures.
struct PictureRoom {
  std::string link{};
  double bits{kNoLimit};  ///< bit/s
};

bool is_number(double value) { return std::isfinite(value) && value > 0.0; }

PictureRoom room_of(const station::SenderReport& sender, const station::AgentTraffic* traffic) {
  if (sender.link.empty() || !is_number(sender.bandwidth)) return {};
  double other = 0.0;  // bit/s
  if (traffic) {
    const auto video = traffic->classes_out.find("video");
    other = 8.0 * (traffic->total_out - (video == traffic->classes_out.end() ? 0.0 : video->second));
  }
  const double left = is_number(other) ? sender.bandwidth - other : sender.bandwidth;
  return {sender.link, std::clamp(left, 0.0, kPictureShare * sender.bandwidth)};
}

/// The rooms of the links in a network report.
class Rooms {
 public:
  explicit Rooms(const station::NetworkReport* net) : net_(net) {}

  /// All robots share the station's air. What the station itself sends does not count.
  PictureRoom of_station() const {
    return net_ && net_->sender ? room_of(*net_->sender, nullptr) : PictureRoom{};
  }
  PictureRoom of(const std::string& robot) const {
    if (!net_) return {};
    const auto link = std::ranges::find(net_->links, robot, &station::LinkReport::agent);
    if (link == net_->links.end() || !link->sender) return of_station();
    const auto traffic = std::ranges::find(net_->agents, robot, &station::AgentTraffic::agent);
    return room_of(*link->sender, traffic == net_->agents.end() ? nullptr : &*traffic);
  }

 private:
  const station::NetworkReport* net_;
};

std::string kbit(double bits) { return station::fixed(bits / 1000.0, 0) + " kbit/s"; }

std::string leaves(const PictureRoom& room) { return room.link + " leaves " + kbit(room.bits); }

/// A rate of pictures as an operator reads it.
std::string often(double rate) {
  return rate >= 1.0 ? station::fixed(rate, rate < kMaxRate ? 1 : 0) + " pictures/s each"
                     : "each every " + station::fixed(1.0 / rate, rate > 0.11 ? 1 : 0) + " s";
}

void list_cameras(const CameraPlanScene& scene, CameraPlan& plan) {
  for (const station::Robot& robot : scene.world->robots) {
    if (robot.cameras.empty()) plan.without.push_back(robot.name);
    for (const station::CameraStatus& camera : robot.cameras) {
      PlannedCamera& out = plan.cameras.emplace_back(
          PlannedCamera{.name = {robot.name, camera.name}, .bytes = camera.on ? camera.bytes : 0.0F});
      out.sharp = out.name == scene.sharp;
      if (scene.off.contains(out.name))
        out.role = CameraRole::off, out.why = "off";
      else if (robot.lost)
        out.role = CameraRole::lost, out.why = robot.name + " is lost";
    }
  }
}

bool is_driven(const station::World& world, const std::string& name) {
  const station::Robot* robot = world.robot(name);
  return robot && station::is_by_hand(robot->mode);
}

/// How many thumbnails are asked for, and how often.
struct Share {
  std::size_t count{};
  std::uint16_t width{kSmallWidth};
  double rate{kMinRate};
};

Share share_of(std::size_t wanted, double bits) {
  Share out{.count = std::min(wanted, kMaxThumbnails)};
  const double fit = std::floor(bits / (kSmallBits * kMinRate) + 1e-6);
  if (fit < static_cast<double>(out.count)) out.count = static_cast<std::size_t>(fit);
  if (out.count < wanted) out.count = std::min(out.count, kMaxInTurns);
  if (out.count == 0) return out;
  const double each = bits / static_cast<double>(out.count);
  const bool wide = each >= kWideBits * kWideRate;
  out.width = wide ? kWideWidth : kSmallWidth;
  out.rate = std::clamp(each / (wide ? kWideBits : kSmallBits), kMinRate, kMaxRate);
  return out;
}

}  // namespace

CameraPlan camera_plan(const CameraPlanScene& scene) {
  CameraPlan plan;
  if (!scene.world) return plan;
  list_cameras(scene, plan);
  const Rooms rooms(scene.net);
  const PictureRoom air = rooms.of_station();
  std::vector<PlannedCamera*> wanted;
  const auto sharp = std::ranges::find_if(plan.cameras, &PlannedCamera::sharp);
  const bool unknown = !scene.world->link.empty() && air.link.empty();
  for (PlannedCamera& camera : plan.cameras) {
    if (camera.role != CameraRole::waits) continue;
    const PictureRoom room = rooms.of(camera.name.first);
    if (room.bits < kSmallBits * kMinRate)
      camera.role = CameraRole::refused, camera.why = "link of " + camera.name.first + ": " + leaves(room);
    else if (camera.sharp)
      camera.role = CameraRole::sharp, camera.rate = kSharpRate;
    else if (scene.in_sight && !scene.in_sight->contains(camera.name))
      camera.why = "out of sight";
    else if (unknown)
      camera.why = "waits for the report of " + scene.world->link;
    else if (room.bits < kAmpleRoom && is_driven(*scene.world, camera.name.first))
      camera.why = camera.name.first + " is driven: its link is the driver's picture's";
    else if (room.bits < kAmpleRoom && sharp != plan.cameras.end() &&
             sharp->name.first == camera.name.first && sharp->role != CameraRole::off)
      camera.why = camera.name.first + " sends the large picture";
    else
      wanted.push_back(&camera);
  }
  const double bits = kThumbnailShare * air.bits;
  const Share share = share_of(wanted.size(), bits);
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    PlannedCamera& camera = *wanted[(i + scene.turn * share.count) % wanted.size()];
    if (i < share.count) {
      camera.role = CameraRole::thumbnail;
      camera.width = share.width;
      camera.rate = static_cast<float>(share.rate);
    } else if (share.count == 0) {
      camera.role = CameraRole::refused;
      camera.why = air.link + " leaves " + kbit(bits) + " for thumbnails";
    } else {
      camera.why = share.count == kMaxInTurns ? "waits for its turn: 6 at once"
                                              : "waits for its turn: " + air.link + " leaves " + kbit(bits);
    }
  }
  if (!air.link.empty())
    plan.summary = leaves(air) + " for pictures, " + kbit(bits) + " of it for thumbnails";
  if (share.count > 0) {
    plan.summary += (plan.summary.empty() ? "" : ": ") + std::to_string(share.count) +
                    (share.count == 1 ? " thumbnail, " : " thumbnails, ") + often(share.rate);
    if (wanted.size() > share.count)
      plan.summary += ", " + std::to_string(wanted.size() - share.count) + " wait for their turn";
  }
  return plan;
}

}  // namespace adit::gui
