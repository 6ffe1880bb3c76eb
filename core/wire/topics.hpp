// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/wire/participant.hpp"

// Generated from idl/; complete only where the generated header is included.
namespace adit::radio {
class Capabilities;
class Presence;
class Command;
class Joystick;
class Acknowledgement;
class AuthorityStatus;
class RobotState;
class BehaviourState;
class Route;
class Notification;
class Health;
class LinkReport;
class BulkPiece;
class BulkAck;
class CameraPiece;
class CameraViews;
class TeamBeacon;
}  // namespace adit::radio
namespace geometry_msgs::msg {
class Twist;
class TwistStamped;
}  // namespace geometry_msgs::msg
namespace nav_msgs::msg {
class Odometry;
}
namespace sensor_msgs::msg {
class PointCloud2;
class LaserScan;
class Imu;
class BatteryState;
class Image;
class CompressedImage;
}  // namespace sensor_msgs::msg
namespace tf2_msgs::msg {
class TFMessage;
}
namespace vision_msgs::msg {
class Detection3DArray;
}

namespace visualization_msgs::msg {
class Marker;
}

namespace adit::wire::topics {

inline constexpr bool kKeyed = true;
inline constexpr bool kUnkeyed = false;

/// Every topic of the radio domain; topic names and QoS are defined only here. Commands and their answers use
/// the newest sample only: a lost one is not repaired by the wire, which would delay those behind it by a
/// round trip or more, but repeated by the sender that waits for an answer.
inline constexpr Topic<radio::Capabilities> kCapabilities{
    {"adit/capabilities", "adit::radio::v1::Capabilities", QosClass::status, 1, kKeyed, 4096}};
inline constexpr Topic<radio::Presence> kPresence{
    {"adit/presence", "adit::radio::v1::Presence", QosClass::state, 1, kKeyed, 256}};
inline constexpr Topic<radio::Command> kCommand{
    {"adit/command", "adit::radio::v1::Command", QosClass::urgent, 1, kUnkeyed, 512}};
inline constexpr Topic<radio::Joystick> kJoystick{
    {"adit/joystick", "adit::radio::v1::Joystick", QosClass::stream, 1, kUnkeyed, 256}};
inline constexpr Topic<radio::Acknowledgement> kAcknowledgement{
    {"adit/acknowledgement", "adit::radio::v1::Acknowledgement", QosClass::urgent, 1, kUnkeyed, 512}};
inline constexpr Topic<radio::AuthorityStatus> kAuthority{
    {"adit/authority", "adit::radio::v1::AuthorityStatus", QosClass::status, 1, kKeyed, 2048}};
inline constexpr Topic<radio::RobotState> kRobotState{
    {"adit/robot_state", "adit::radio::v1::RobotState", QosClass::state, 1, kKeyed, 256}};
inline constexpr Topic<radio::BehaviourState> kBehaviour{
    {"adit/behaviour", "adit::radio::v1::BehaviourState", QosClass::status, 1, kKeyed, 5120}};
inline constexpr Topic<radio::Route> kRoute{
    {"adit/route", "adit::radio::v1::Route", QosClass::status, 1, kKeyed, 512}};
inline constexpr Topic<radio::Notification> kNotification{
    {"adit/notification", "adit::radio::v1::Notification", QosClass::status, 8, kKeyed, 1024}};
inline constexpr Topic<radio::Health> kHealth{
    {"adit/health", "adit::radio::v1::Health", QosClass::status, 1, kKeyed, 4096}};
inline constexpr Topic<radio::LinkReport> kLinkReport{
    {"adit/link", "adit::radio::v1::LinkReport", QosClass::state, 1, kKeyed, 4096}};

/// Pieces of content (core/transfer): findings, maps; and their acknowledgements.
inline constexpr Topic<radio::BulkPiece> kBulk{
    {"adit/bulk", "adit::radio::v1::BulkPiece", QosClass::pieces, 32, kUnkeyed, 1400}};
inline constexpr Topic<radio::BulkAck> kBulkAck{
    {"adit/bulk_ack", "adit::radio::v1::BulkAck", QosClass::pieces, 4, kUnkeyed, 1400}};
/// Partition of both topics for the robots that carry maps: they acknowledge there, and a robot that no
/// station hears sends there.
inline constexpr const char* kCarryPartition = "carry";

/// Pictures of cameras, in pieces that decode alone, and what stations look at and got of them.
inline constexpr Topic<radio::CameraPiece> kCamera{
    {"adit/camera", "adit::radio::v1::CameraPiece", QosClass::video, 32, kUnkeyed, 1400}};
inline constexpr Topic<radio::CameraViews> kCameraViews{
    {"adit/camera_views", "adit::radio::v1::CameraViews", QosClass::pieces, 1, kUnkeyed, 2800}};

/// Robots to robots: position, motion, and their parts in what several robots do together.
inline constexpr Topic<radio::TeamBeacon> kTeam{
    {"adit/team", "adit::radio::v1::TeamBeacon", QosClass::state, 1, kKeyed, 1024}};

/// Topics of the robot domain: ROS 2 names and types, for drivers.
inline constexpr Topic<geometry_msgs::msg::Twist> kCmdVel{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::Twist_", QosClass::urgent, 1, kUnkeyed, 64}};
inline constexpr Topic<geometry_msgs::msg::TwistStamped> kCmdVelStamped{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_", QosClass::urgent, 1, kUnkeyed, 256}};
/// The same topic for a reader that detects a second writer, reliable or not.
inline constexpr Topic<geometry_msgs::msg::Twist> kCmdVelHeard{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::Twist_", QosClass::state, 1, kUnkeyed, 64}};
inline constexpr Topic<geometry_msgs::msg::TwistStamped> kCmdVelStampedHeard{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_", QosClass::state, 1, kUnkeyed, 256}};
/// Velocity that a program of the robot requests in the mode `external`.
inline constexpr Topic<geometry_msgs::msg::Twist> kExternalCmdVel{
    {"rt/external/cmd_vel", "geometry_msgs::msg::dds_::Twist_", QosClass::state, 1, kUnkeyed, 64}};
/// The same topic for a program that stamps its velocities; the agent reads the one that is written.
inline constexpr Topic<geometry_msgs::msg::TwistStamped> kExternalCmdVelStamped{
    {"rt/external/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_", QosClass::state, 1, kUnkeyed, 256}};
inline constexpr Topic<nav_msgs::msg::Odometry> kOdom{
    {"rt/odom", "nav_msgs::msg::dds_::Odometry_", QosClass::state, 1, kUnkeyed, 2048}};
inline constexpr Topic<sensor_msgs::msg::PointCloud2> kPoints{
    {"rt/points", "sensor_msgs::msg::dds_::PointCloud2_", QosClass::sensor, 1, kUnkeyed, 4 << 20}};
/// Scan of a planar lidar.
inline constexpr Topic<sensor_msgs::msg::LaserScan> kScan{
    {"rt/scan", "sensor_msgs::msg::dds_::LaserScan_", QosClass::sensor, 1, kUnkeyed, 1 << 20}};
/// Angular velocity and specific force. The history holds the samples of the fastest sensor, 400 Hz, in 100
/// ms, as a reader integrates every sample.
inline constexpr Topic<sensor_msgs::msg::Imu> kImu{
    {"rt/imu/data", "sensor_msgs::msg::dds_::Imu_", QosClass::sensor, 40, kUnkeyed, 2048}};
/// The fixed frames of the robot.
inline constexpr Topic<tf2_msgs::msg::TFMessage> kTfStatic{
    {"rt/tf_static", "tf2_msgs::msg::dds_::TFMessage_", QosClass::status, 16, kUnkeyed, 1 << 16}};
inline constexpr Topic<sensor_msgs::msg::BatteryState> kBattery{
    {"rt/battery_state", "sensor_msgs::msg::dds_::BatteryState_", QosClass::state, 1, kUnkeyed, 2048}};
/// Objects that programs of the robot detect.
inline constexpr Topic<vision_msgs::msg::Detection3DArray> kDetections{
    {"rt/detections", "vision_msgs::msg::dds_::Detection3DArray_", QosClass::sensor, 4, kUnkeyed, 1 << 20}};
/// What programs of the robot report, with a text, a place and a photo. A message may be far larger than a
/// photo that is used, so that a photo that is too large costs its finding only the photo.
inline constexpr Topic<visualization_msgs::msg::Marker> kReports{
    {"rt/reports", "visualization_msgs::msg::dds_::Marker_", QosClass::bulk, 8, kUnkeyed, 24 << 20}};

/// Pictures of a camera as its driver sends them; see CameraConfig for the names.
inline constexpr Topic<sensor_msgs::msg::Image> kImage{
    {"rt/camera/image_raw", "sensor_msgs::msg::dds_::Image_", QosClass::sensor, 1, kUnkeyed, 32 << 20}};
inline constexpr Topic<sensor_msgs::msg::CompressedImage> kCompressedImage{
    {"rt/camera/image_raw/compressed", "sensor_msgs::msg::dds_::CompressedImage_", QosClass::sensor, 1,
     kUnkeyed, 16 << 20}};

}  // namespace adit::wire::topics
