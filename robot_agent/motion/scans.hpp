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
  Time received{};                       ///< When the sample arrived, by our clock.
};
/// Takes scans; offered by whoever uses them.
using ScanService = Service<LidarScan, void>;

/// Unpacks the lidar's clouds, or a planar one's scans, on a strand of its own, so that they never hold the
/// command strand up.
class Scans : public Component {
 public:
  /// `lidar_height`: of a planar lidar above the ground, m.
  Scans(Executor& strand, Log log, double lidar_height, const ScanService& output);
  /// On its strand; nothing when it does not run.
  void take(const sensor_msgs::msg::PointCloud2& cloud, Time received);
  void take(const sensor_msgs::msg::LaserScan& scan, Time received);

  struct Readers {
    std::unique_ptr<wire::RawReader> points{}, scan{};
  };
  /// Readers of /points and of /scan; `taker` gives who takes them now, on the strand of `io`, or null.
  /// Errors of the wire.
  static Result<Readers> read(const wire::ComponentIo& io, std::function<Scans*()> taker);

 private:
  void give(const std::function<Result<PointCloud>()>& points, const std_msgs::msg::Header& header,
            Time received);

  double lidar_height_;
  const ScanService& output_;
};

/// The points of a cloud that has float32 x, y and z; not finite ones are left out. Reason::malformed when
/// the layout does not fit the data.
Result<PointCloud> to_points(const sensor_msgs::msg::PointCloud2& cloud);
/// The points of a planar scan, `height` m above the ground; what met nothing, or is out of the scanner's
/// range, is left out. Reason::malformed when its angles are no numbers or turn more than once.
Result<PointCloud> to_points(const sensor_msgs::msg::LaserScan& scan, double height);

}  // namespace adit::agent
