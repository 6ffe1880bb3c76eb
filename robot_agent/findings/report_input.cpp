// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/report_input.hpp"

#include <cmath>
#include <utility>

#include "core/findings/mark_data.hpp"
#include "core/wire/topics.hpp"
#include "visualization_msgs/msg/Marker.h"

namespace adit::agent {
namespace {

constexpr std::size_t kMaxInputs = 1024;

/// Whether an operator would notice no difference.
bool is_alike(const findings::Finding& a, const findings::Finding& b) {
  const double moved =
      std::hypot(a.position[0] - b.position[0], a.position[1] - b.position[1], a.position[2] - b.position[2]);
  return a.kind == b.kind && a.text == b.text && a.importance == b.importance && a.withdrawn == b.withdrawn &&
         a.photo == b.photo && moved < ReportInput::kMoved;
}

}  // namespace

ReportInput::ReportInput(ReportParams params, const Platform& platform, std::shared_ptr<StaticFrames> frames,
                         FindingSource& findings, findings::PhotoStore& photos, Executor& home,
                         TopicRefusals::Fault fault)
    : params_(std::move(params)),
      placer_(platform, std::move(frames)),
      findings_(findings),
      photos_(photos),
      home_(home),
      refusals_(std::move(fault)) {}

Result<void> ReportInput::open(const wire::ComponentIo& io) {
  names_.reserve(params_.topics.size());  // The topics refer to the names.
  for (const std::string& topic : params_.topics) {
    wire::Topic<visualization_msgs::msg::Marker> named = wire::topics::kReports;
    named.name = names_.emplace_back("rt/" + topic).c_str();
    const auto take_it = [this, topic](const visualization_msgs::msg::Marker& message,
                                       const wire::SampleInfo& info) { take(message, topic, info.received); };
    if (auto opened = io.open(readers_.emplace_back(), named, take_it); !opened) return opened.error();
  }
  return {};
}

void ReportInput::take(const visualization_msgs::msg::Marker& message, const std::string& topic,
                       Time received) {
  if (!first_) first_ = received;
  auto report = report_of(message);
  if (!report) return refusals_.refuse(topic, report.error());
  const auto importance = params_.importance.find(report->object.kind);
  if (importance != params_.importance.end() && importance->second == 0) return;
  if (report->withdraws)  // Also reports that are queued.
    std::erase_if(waiting_, [&](const Waiting& each) { return each.report.id == report->id; });
  if (report->no_photo) refusals_.refuse(topic, *report->no_photo);
  std::size_t photos = decoding_.size();
  for (const Waiting& each : waiting_) photos += each.report.jpeg ? 1 : 0;
  if (report->jpeg && photos >= kPhotos) {
    report->jpeg.reset();
    refusals_.refuse(topic, {Reason::queue_full, "more photos than can be decoded in this time"});
  }
  if (waiting_.size() >= kWaiting) {
    refusals_.refuse(waiting_.front().topic, {Reason::queue_full, "more reports than can wait for odometry"});
    waiting_.pop_front();
  }
  waiting_.push_back({std::move(*report), topic, received});
}

void ReportInput::tick(const RobotPlace& place, Time now) {
  std::deque<Waiting> later;
  while (!waiting_.empty()) {
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    const auto frame_comes = [&] {  // A report comes once: it waits for the frames of /tf_static.
      return first_ && now - *first_ < kFramesCome &&
             placer_.placed(next.report.object, place).reason() == Reason::frame_unknown;
    };
    const bool waits =
        !next.report.withdraws &&
        (ObjectPlacer::must_wait(next.report.object, next.received, place.frames, now) || frame_comes());
    if (waits)
      later.push_back(std::move(next));
    else
      place_and_report(std::move(next), place, now);
  }
  waiting_ = std::move(later);
}

void ReportInput::place_and_report(Waiting next, const RobotPlace& place, Time now) {
  if (next.report.withdraws) return withdraw(next);
  const auto at = placer_.placed(next.report.object, place);
  if (!at) return refusals_.refuse(next.topic, at.error());
  findings::Finding finding = finding_of(next.report, *at, now);
  const auto decoding = decoding_.find(finding.key.id);
  if (decoding != decoding_.end()) {
    // The photo that is being decoded goes with the newest content; one more of the same finding is left out.
    decoding->second = std::move(finding);
    if (next.report.jpeg)
      refusals_.refuse(next.topic,
                       {Reason::queue_full, "a photo of the same finding is still being decoded"});
    return;
  }
  if (next.report.jpeg) return decode(next, std::move(finding));
  put(next.topic, std::move(finding));
}

void ReportInput::withdraw(const Waiting& waiting) {
  decoding_.erase(waiting.report.id);
  inputs_.erase(waiting.report.id);
  const findings::Finding* stored = findings_.newest(waiting.report.id);
  if (stored == nullptr || stored->withdrawn) return;
  if (const auto done = findings_.withdraw(waiting.report.id); !done)
    refusals_.refuse(waiting.topic, done.error());
}

findings::Finding ReportInput::finding_of(const Report& report, const Eigen::Vector3d& place,
                                          Time now) const {
  const auto importance = params_.importance.find(report.object.kind);
  findings::Finding out{.kind = report.object.kind,
                        .importance = importance != params_.importance.end()
                                          ? importance->second
                                          : findings::usual_importance(report.object.kind),
                        .position = {place.x(), place.y(), place.z()},
                        .stamp = to_stamp(now),
                        .text = report.object.text};
  out.key.id = report.id;
  // A report without a photo leaves the one that is there.
  if (const findings::Finding* stored = findings_.newest(report.id)) out.photo = stored->photo;
  return out;
}

void ReportInput::decode(const Waiting& waiting, findings::Finding finding) {
  const std::uint64_t id = waiting.report.id;
  decoding_[id] = std::move(finding);
  const auto known = inputs_.find(id);
  const std::optional<std::uint64_t> last =
      known != inputs_.end() ? std::optional(known->second) : std::nullopt;
  home_.compute(
      {.name = "photo", .modelled = 300ms, .watchdog = 30s, .priority = JobPriority::low, .lane = "photo"},
      [jpeg = waiting.report.jpeg, last](const std::stop_token& stop) -> Result<Made> {
        const std::uint64_t hash = findings::photo_hash(*jpeg);
        if (last == hash) return Made{{}, hash};
        auto photo = findings::make_photo(*jpeg, stop);
        if (!photo) return photo.error();
        return Made{std::move(*photo), hash};
      },
      [this, id, topic = waiting.topic, alive = std::weak_ptr(alive_)](const Result<Made>& made) {
        if (!alive.expired()) decoded(id, topic, made);
      });
}

void ReportInput::decoded(std::uint64_t id, const std::string& topic, const Result<Made>& made) {
  const auto decoding = decoding_.extract(id);
  if (decoding.empty()) return;  // It was withdrawn meanwhile.
  findings::Finding finding = std::move(decoding.mapped());
  if (!made) {
    refusals_.refuse(topic, made.error());
  } else if (made->photo) {
    const findings::Photo& photo = *made->photo;
    if (inputs_.size() >= kMaxInputs) inputs_.clear();
    inputs_[id] = made->input;
    if (photos_.put(photo, finding.importance))
      finding.photo = findings::ref_of(photo);
    else
      refusals_.refuse(topic, {Reason::queue_full, "no room for one more photo"});
  }
  put(topic, std::move(finding));
}

void ReportInput::put(const std::string& topic, findings::Finding finding) {
  const findings::Finding* stored = findings_.newest(finding.key.id);
  if (stored == nullptr) {
    if (!new_findings_.take(home_.now()))
      return refusals_.refuse(topic, {Reason::queue_full, "more than " + std::to_string(ReportRate::kBurst) +
                                                              " new reports at once and one a second"});
    if (const auto taken = findings_.report(std::move(finding)); !taken)
      refusals_.refuse(topic, taken.error());
    return;
  }
  if (is_alike(*stored, finding)) return;
  if (const auto changed = findings_.update(std::move(finding)); !changed)
    refusals_.refuse(topic, changed.error());
}

void ReportInput::look(const wire::Participant& wire) {
  refusals_.look(wire, params_.topics,
                 "a message is no visualization_msgs/msg/Marker, or has more than " +
                     std::to_string(wire::topics::kReports.max_bytes / 1024) + " kB");
}

}  // namespace adit::agent
