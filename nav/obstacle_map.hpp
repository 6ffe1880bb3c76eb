#pragma once
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/config/platform.hpp"
#include "core/geometry/pose.hpp"
#include "nav/ground_map.hpp"
#include "nav/ray_image.hpp"

namespace adit::nav {

struct ObstacleMapParams {
  double range{4.5};           ///< obstacles are kept this far around the robot, m, [1, 6]
  double height_margin{0.15};  ///< what hangs this much above body and lidar is passed under, m, [0, 1]
  double step_margin{0.025};   ///< more than the step's height by this is an obstacle, m: a kerb of exactly
                               ///< the step, measured with noise, must not be one, [0, 0.1]
  double drop{
      0.20};  ///< ground lower than expected by this is a hole (at least twice the step), m, [0.05, 2]
  double memory{4.0};  ///< an obstacle that is hidden is forgotten after, s, (0, 60]
  int misses{3};       ///< consecutive scans that saw through a cell before it is free, [1, 100]
  double body_margin{
      0.02};               ///< returns from this close around the own footprint are the own body, m, [0, 0.5]
  double min_range{0.05};  ///< shorter returns are not returns, m, [0, 1]
  double blind_range{
      0.6};            ///< obstacles this near to the lidar are kept until rays went through them, m, [0, 2]
  double slope{0.35};  ///< steepest ground, rise per run, [0, 1]
};

/// What the robot must not touch: the returns of its lidar that stand higher above the ground than its step
/// and lower than its body, as 5 cm cells in the odometry frame. A cell stays until rays went through it in
/// several scans (a robot that moved on leaves no ghost), until it was hidden for `memory`, or until the
/// robot leaves it behind; a cell below the lowest ray (the blind spot of a spinning lidar) is remembered as
/// long as it is near.
class ObstacleMap {
 public:
  static constexpr float kCell = 0.05f;             ///< m
  static constexpr std::size_t kMaxCells = 50'000;  ///< every cell within the largest range fits

  explicit ObstacleMap(const Platform& platform, const ObstacleMapParams& params = {});

  /// Takes one scan. `points`: in base_link, m, not finite or within min_range of the lidar (which is
  /// lidar_height above base_link) where nothing was hit. `body`: base_link, which is on the ground, in the
  /// odometry frame at the scan's time. `stamp_s`: that time, s, not decreasing.
  void add_scan(std::span<const Eigen::Vector3f> points, const Pose3& body, double stamp_s);

  /// Centres of the occupied cells, odometry frame, m; valid until the next scan.
  std::span<const Eigen::Vector2f> cells() const { return cells_; }
  const GroundMap& ground() const { return ground_; }
  /// Forgets everything, as after a jump of the odometry.
  void clear();

 private:
  static constexpr int kTorus = 256;  ///< 12.8 m: more than twice the range
  struct Entry {
    int ix, iy;
    float z_low, z_high;
    std::uint32_t scan;
    std::int32_t hits;  ///< of the newest scan that hit it
    std::int32_t misses;
    bool solid;  ///< once hit by more than stray returns
    double stamp;
  };

  static int cell(float v) { return floor_int(v * (1.0f / kCell)); }
  static std::size_t slot(int ix, int iy) {
    return static_cast<std::size_t>((ix & (kTorus - 1)) * kTorus + (iy & (kTorus - 1)));
  }
  void mark(const Eigen::Vector3f& point, double stamp_s);
  bool keep(Entry& entry, const Eigen::Vector3f& sensor, double stamp_s) const;
  bool stray(const Entry& entry, float dx, float dy, float range) const;
  bool in_body(float dx, float dy, double margin) const;

  Platform platform_;
  ObstacleMapParams params_;
  GroundMap ground_;
  RayImage rays_{};
  std::vector<Eigen::Vector3f> near_{};  ///< returns within range, odometry frame
  std::vector<std::uint16_t> slots_;     ///< index into entries_ plus one, or 0
  std::vector<Entry> entries_{};
  std::vector<Eigen::Vector2f> cells_{};
  std::uint32_t scan_{0};
  float body_x_{}, body_y_{}, body_cos_{1}, body_sin_{};
};

}  // namespace adit::nav
