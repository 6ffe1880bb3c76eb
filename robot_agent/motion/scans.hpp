// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>

#include "core/component/call.hpp"
#include "core/component/component.hpp"
#include "core/geometry/pose.hpp"
#include "core/wire/participant.hpp"

namespace sensor_msgs::msg {
class PointCloud2;
class LaserScan;
}  // namespace sensor_msgs::msg
namespace std_msgs::msg {
class Header;
}

namespace adit::wire {
struct ComponentIo;
}

namespace adit::agent {

/// A lidar's scan.
struct LidarScan {
  std::shared_ptr<PointCloud> points{};  ///< In the frame of base_link, m.
  std::uint64_t stamp{};                 ///< Of the driver's clock, ns.
  Time received{};                       ///< Time of reception, by the agent's clock.
};
/// The service that accepts scans; the component that uses them offers it.
using ScanService = Service<LidarScan, void>;

/// The component that unpacks the lidar's point clouds, or the scans of a planar lidar, on a strand of its
/// own, so that they never delay the command strand.
class Scans : public Component {
 public:
  /// `lidar_height`: height of a planar lidar above the ground, m.
  Scans(Executor& strand, Log log, double lidar_height, const ScanService& output);
  /// Processes a message. Call it on the component's strand; it does nothing if the component is not running.
  void take(const sensor_msgs::msg::PointCloud2& cloud, Time received);
  void take(const sensor_msgs::msg::LaserScan& scan, Time received);

  struct Readers {
    std::unique_ptr<wire::RawReader> points{}, scan{};
  };
  /// Makes the readers of /points and /scan. `taker` returns the component that processes them, or null; it
  /// is called on the strand of `io`. Errors: those of the participant.
  static Result<Readers> read(const wire::ComponentIo& io, std::function<Scans*()> taker);

 private:
  void give(const std::function<Result<PointCloud>()>& points, const std_msgs::msg::Header& header,
            Time received);

  double lidar_height_;
  const ScanService& output_;
};

/// Converts a cloud with float32 x, y and z; points that are not finite are omitted. Errors: malformed if the
/// layout does not fit the data.
Result<PointCloud> to_points(const sensor_msgs::msg::PointCloud2& cloud);
/// Converts a planar scan, `height` m above the ground, to points; beams without a return or out of the
/// scanner's range are omitted. Errors: malformed if its angles are not finite or span more than one turn.
Result<PointCloud> to_points(const sensor_msgs::msg::LaserScan& scan, double height);

}  // namespace adit::agent
