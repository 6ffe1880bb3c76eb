#pragma once
#include "core/wire/wire.hpp"

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
class Notification;
class Health;
class LinkReport;
class Finding;
class FindingsAck;
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
}  // namespace sensor_msgs::msg

namespace adit::wire::topics {

inline constexpr bool keyed = true;
inline constexpr bool unkeyed = false;

/// Every topic of the radio domain. Commands and their answers keep the newest alone: a lost one is not
/// repaired in its turn, which would hold up those behind it for a round trip and more, but repeated by
/// whoever waits for an answer. Nobody else writes a topic name or a QoS.
inline constexpr Topic<radio::Capabilities> capabilities{
    {"adit/capabilities", "adit::radio::v1::Capabilities", QosClass::status, 1, keyed, 4096}};
inline constexpr Topic<radio::Presence> presence{
    {"adit/presence", "adit::radio::v1::Presence", QosClass::state, 1, keyed, 256}};
inline constexpr Topic<radio::Command> command{
    {"adit/command", "adit::radio::v1::Command", QosClass::urgent, 1, unkeyed, 512}};
inline constexpr Topic<radio::Joystick> joystick{
    {"adit/joystick", "adit::radio::v1::Joystick", QosClass::stream, 1, unkeyed, 256}};
inline constexpr Topic<radio::Acknowledgement> acknowledgement{
    {"adit/acknowledgement", "adit::radio::v1::Acknowledgement", QosClass::urgent, 1, unkeyed, 512}};
inline constexpr Topic<radio::AuthorityStatus> authority{
    {"adit/authority", "adit::radio::v1::AuthorityStatus", QosClass::status, 1, keyed, 2048}};
inline constexpr Topic<radio::RobotState> robot_state{
    {"adit/robot_state", "adit::radio::v1::RobotState", QosClass::state, 1, keyed, 256}};
inline constexpr Topic<radio::BehaviourState> behaviour{
    {"adit/behaviour", "adit::radio::v1::BehaviourState", QosClass::status, 1, keyed, 2048}};
inline constexpr Topic<radio::Notification> notification{
    {"adit/notification", "adit::radio::v1::Notification", QosClass::status, 8, keyed, 1024}};
inline constexpr Topic<radio::Health> health{
    {"adit/health", "adit::radio::v1::Health", QosClass::status, 1, keyed, 4096}};
inline constexpr Topic<radio::LinkReport> link_report{
    {"adit/link", "adit::radio::v1::LinkReport", QosClass::state, 1, keyed, 4096}};
inline constexpr Topic<radio::Finding> finding{
    {"adit/finding", "adit::radio::v1::Finding", QosClass::bulk, 8, unkeyed, 1024}};
inline constexpr Topic<radio::FindingsAck> findings_ack{
    {"adit/findings_ack", "adit::radio::v1::FindingsAck", QosClass::bulk, 8, unkeyed, 1024}};

/// The robot domain: ROS 2 names and types towards drivers.
inline constexpr Topic<geometry_msgs::msg::Twist> cmd_vel{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::Twist_", QosClass::urgent, 1, unkeyed, 64}};
inline constexpr Topic<geometry_msgs::msg::TwistStamped> cmd_vel_stamped{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_", QosClass::urgent, 1, unkeyed, 256}};
/// The same topic for a reader that looks for a second writer, reliable or not.
inline constexpr Topic<geometry_msgs::msg::Twist> cmd_vel_heard{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::Twist_", QosClass::state, 1, unkeyed, 64}};
inline constexpr Topic<geometry_msgs::msg::TwistStamped> cmd_vel_stamped_heard{
    {"rt/cmd_vel", "geometry_msgs::msg::dds_::TwistStamped_", QosClass::state, 1, unkeyed, 256}};
/// What a program of the robot asks for in the mode `external`.
inline constexpr Topic<geometry_msgs::msg::Twist> external_cmd_vel{
    {"rt/external/cmd_vel", "geometry_msgs::msg::dds_::Twist_", QosClass::state, 1, unkeyed, 64}};
inline constexpr Topic<nav_msgs::msg::Odometry> odom{
    {"rt/odom", "nav_msgs::msg::dds_::Odometry_", QosClass::state, 1, unkeyed, 2048}};
inline constexpr Topic<sensor_msgs::msg::PointCloud2> points{
    {"rt/points", "sensor_msgs::msg::dds_::PointCloud2_", QosClass::sensor, 1, unkeyed, 4 << 20}};
/// A lidar that sees one plane.
inline constexpr Topic<sensor_msgs::msg::LaserScan> scan{
    {"rt/scan", "sensor_msgs::msg::dds_::LaserScan_", QosClass::sensor, 1, unkeyed, 1 << 20}};
/// Angular velocity and specific force. Its history holds what the fastest sensor, 400 Hz, gives in 100 ms: a
/// reader integrates every sample.
inline constexpr Topic<sensor_msgs::msg::Imu> imu{
    {"rt/imu/data", "sensor_msgs::msg::dds_::Imu_", QosClass::sensor, 40, unkeyed, 2048}};
inline constexpr Topic<sensor_msgs::msg::BatteryState> battery{
    {"rt/battery_state", "sensor_msgs::msg::dds_::BatteryState_", QosClass::state, 1, unkeyed, 2048}};

}  // namespace adit::wire::topics
