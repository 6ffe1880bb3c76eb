// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/findings/photo.hpp"
#include "core/time/time.hpp"
#include "perception/objects/object_detector.hpp"

namespace adit::agent {

/// The key `detections` of a robot's file: objects that programs on the robot detect.
struct DetectionParams {
  static constexpr std::size_t kMaxTopics = 4;

  std::vector<std::string> topics{"detections"};  ///< Without a slash in front.
  double min_score{0.5};                          ///< Hypotheses below it are ignored, [0, 1].
  int sightings{3};  ///< Messages with an object before it is a finding, [1, 100].
  std::map<std::string, std::uint8_t> importance{};  ///< By kind; 0: the kind is ignored.
  std::uint8_t default_importance{5};                ///< Of other kinds.
  double same{1.0};    ///< Objects of one kind without ids that are nearer to each other are one, m.
  Duration lapse{3s};  ///< Sightings that are farther apart do not confirm each other.

  std::uint8_t importance_of(const std::string& kind) const {
    const auto known = importance.find(kind);
    return known != importance.end() ? known->second : default_importance;
  }
};

/// The key `reports` of a robot's file: findings that programs on the robot report with a text and a photo.
struct ReportParams {
  static constexpr std::size_t kMaxTopics = 4;

  std::vector<std::string> topics{"reports"};  ///< Without a slash in front.
  std::map<std::string, std::uint8_t>
      importance{};  ///< By kind; 0: it is ignored. Of others, that of a mark.
};

/// An object in one message of a program on the robot.
struct Detection {
  std::string source{};  ///< The topic and the participant that sent it.
  std::string id{};      ///< Of the object, in all messages of the source; empty: the program gives none.
  std::string kind{};    ///< See findings::Finding::kind.
  double score{};        ///< [0, 1].
  std::string text{};    ///< For operators; empty: the score is its text.
  Eigen::Vector3d position{0, 0, 0};  ///< In `frame`, m.
  std::string frame{};
  std::uint64_t stamp{};                           ///< The driver's clock, ns; 0: it has none.
  double sigma{};                                  ///< Standard deviation of its place, m; 0: unknown.
  std::shared_ptr<const findings::Photo> photo{};  ///< Null: there is none.
};

/// The key `objects` of a robot's file: objects that the agent itself detects in pictures of its cameras.
struct ObjectsParams {
  perception::DetectorParams detector{};
  Duration period{1s};  ///< Between two pictures of all cameras, [1, 60] s.
  DetectionParams report{.topics = {}, .sightings = 2, .same = 2.0};
};

/// The kind of a class: its first 32 bytes, with _ for what is neither letter, digit, dot nor dash. `stairs`
/// becomes `staircase`, because a finding of kind `stairs` has measured steps.
std::string kind_of(const std::string& class_id);

}  // namespace adit::agent
