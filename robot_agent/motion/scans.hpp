#pragma once
#include <functional>
#include <memory>

#include "core/component/component.hpp"
#include "core/geometry/pose.hpp"
#include "core/wire/wire.hpp"

namespace sensor_msgs::msg {
class PointCloud2;
}

namespace adit::agent {

/// Unpacks the lidar's clouds on a strand of its own, so that they never hold the command strand up.
class Scans : public Component {
 public:
  /// Points in the frame of base_link, m; `stamp` is of the driver's clock, ns. On this strand.
  using Output = std::function<void(std::shared_ptr<PointCloud> points, std::uint64_t stamp)>;

  Scans(Executor& strand, Log log, Output output);
  /// On its strand; nothing when it does not run.
  void take(const sensor_msgs::msg::PointCloud2& cloud);

  /// The reader of the clouds; `taker` gives who takes them now, on `strand`, or null. Errors of the wire.
  static Result<std::unique_ptr<wire::RawReader>> read(wire::Wire& robot, Executor& strand,
                                                       std::function<Scans*()> taker);

 private:
  Output output_;
};

/// The points of a cloud that has float32 x, y and z; not finite ones are left out. Reason::malformed when
/// the layout does not fit the data.
Result<PointCloud> to_points(const sensor_msgs::msg::PointCloud2& cloud);

}  // namespace adit::agent
