// SPDX-License-Identifier: Apache-2.0
#include "basestation/model/camera.hpp"

#include "core/contract/camera.hpp"

namespace adit::station {

std::vector<std::string> cameras_of(const std::vector<std::string>& sensors) {
  std::vector<std::string> out;
  for (const std::string& sensor : sensors)
    if (sensor.starts_with(contract::kCameraSensor))
      out.push_back(sensor.substr(contract::kCameraSensor.size()));
  return out;
}

}  // namespace adit::station
