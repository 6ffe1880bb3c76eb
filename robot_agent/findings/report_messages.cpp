// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/findings/report_messages.hpp"

#include "core/findings/finding.hpp"
#include "core/findings/photo.hpp"
#include "perception/input/frame_tree.hpp"
#include "robot_agent/findings/detection_messages.hpp"
#include "robot_agent/motion/sensor_messages.hpp"
#include "visualization_msgs/msg/Marker.h"

namespace adit::agent {
namespace {

constexpr std::int32_t kAdd = 0, kDelete = 2;

/// At most Finding::kText bytes, without a part of a character at the end.
std::string cut_text(const std::string& text) {
  std::size_t size = std::min(text.size(), findings::Finding::kText);
  while (size < text.size() && size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0U) == 0x80U) --size;
  return text.substr(0, size);
}

void take_photo(const sensor_msgs::msg::CompressedImage& image, Report& report) {
  if (image.data().empty()) return;
  if (const auto readable = findings::check_photo_size(image.data().size()); !readable)
    report.no_photo = readable.error();
  else
    report.jpeg = std::make_shared<const store::Bytes>(image.data());
}

}  // namespace

std::uint64_t report_id(const std::string& ns, std::int32_t number) {
  std::string name = "report " + ns + '\0';
  for (int shift = 0; shift < 32; shift += 8)
    name += static_cast<char>(static_cast<std::uint32_t>(number) >> shift & 0xffU);
  const std::uint64_t id =
      findings::photo_hash({reinterpret_cast<const std::uint8_t*>(name.data()), name.size()});
  return id != 0 ? id : 1;
}

Result<Report> report_of(const visualization_msgs::msg::Marker& message) {
  const std::string& ns = message.ns();
  if (ns.empty() || ns.size() > kMaxNameBytes)
    return Error{Reason::malformed,
                 "the ns of a report, its kind, is empty or too long: '" + shown(ns) + "'"};
  Report out{.id = report_id(ns, message.id())};
  out.object.kind = kind_of(ns);
  if (message.action() == kDelete) {
    out.withdraws = true;
    return out;
  }
  if (message.action() != kAdd)
    return Error{Reason::malformed, "a report's action is " + std::to_string(message.action()) +
                                        ", expected 0 (add or change) or 2 (delete)"};
  const std::string& frame = message.header().frame_id();
  if (frame.empty() || frame.size() > kMaxNameBytes)
    return Error{Reason::frame_unknown, frame.empty() ? "a report has no frame_id"
                                                      : "a frame_id is too long: '" + shown(frame) + "'"};
  out.object.frame = perception::frame_name(frame);
  out.object.stamp = nanoseconds_of(message.header());
  const auto& at = message.pose().position();
  out.object.position = {at.x(), at.y(), at.z()};
  if (const auto good = check_place(out.object, ns); !good) return good.error();
  out.object.text = cut_text(message.text());
  take_photo(message.texture(), out);
  return out;
}

}  // namespace adit::agent
