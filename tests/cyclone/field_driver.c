/* A robot's driver as the field has them: a room of 10 m x 8 m, a lidar of 16 rings x 512 columns at 0.6 m, odometry at
   50 Hz, and on request what drivers do wrong. Arguments are key=value:
   domain=N  seconds=S  frame=NAME (of the cloud)  layout=none|ouster|hesai|livox
   lost=N (first columns without a return)  lost_time=ok|zero|wrapped (the time of their points)
   tf_at=S (when /tf_static is published, once)  quat=ok|zero (orientation of the odometry)
   imu=none|ok|zero (zero: without stamps)  scan=none|ok|ns (/scan; ns: time_increment in ns)  spin=RAD/S
   battery=P (percentage)  velocity=plain|stamped (the type of /cmd_vel that it obeys)
   external=none|plain|stamped (a program that sends 0.3 m/s to /external/cmd_vel, as Twist or TwistStamped) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "node.h"

static int count;
static char **words;

static const char *option(const char *key, const char *usual) {
  const size_t length = strlen(key);
  for (int i = 1; i < count; ++i)
    if (!strncmp(words[i], key, length) && words[i][length] == '=') return words[i] + length + 1;
  return usual;
}
static bool is(const char *key, const char *value) { return !strcmp(option(key, "none"), value); }

enum { kRings = 16, kColumns = 512, kMostStep = 48, kU8 = 2, kU16 = 4, kU32 = 6, kF32 = 7, kF64 = 8 };
typedef struct {
  const char *name;
  uint32_t offset;
  uint8_t type;
} Field;
static const Field kOuster[] = {{"x", 0, kF32},  {"y", 4, kF32},           {"z", 8, kF32},
                                {"intensity", 16, kF32}, {"t", 20, kU32},  {"reflectivity", 24, kU16},
                                {"ring", 26, kU16},      {"ambient", 28, kU16}, {"range", 32, kU32}};
static const Field kHesai[] = {{"x", 0, kF32},          {"y", 4, kF32},      {"z", 8, kF32},
                               {"intensity", 12, kF32}, {"ring", 16, kU16}, {"timestamp", 18, kF64}};
static const Field kLivox[] = {{"x", 0, kF32},          {"y", 4, kF32},    {"z", 8, kF32},          {"intensity", 12, kF32},
                               {"tag", 16, kU8}, {"line", 17, kU8}, {"timestamp", 18, kF64}};

/* Where the robot is, and what it was told. */
static double x, y, yaw, spin;
static geometry_msgs_msg_dds__TwistStamped_ told;
static double turn(void) { return told.twist.angular.z + spin; }

/* The distance to the floor or a wall from a lidar at 0.6 m. */
static double cast(double dx, double dy, double dz) {
  double best = 1e9;
  if (dz < -1e-9) best = fmin(best, 0.6 / -dz);
  if (dx > 1e-9) best = fmin(best, (5 - x) / dx);
  if (dx < -1e-9) best = fmin(best, (5 + x) / -dx);
  if (dy > 1e-9) best = fmin(best, (4 - y) / dy);
  if (dy < -1e-9) best = fmin(best, (4 + y) / -dy);
  return best;
}

static builtin_interfaces_msg_dds__Time_ ago(double seconds) {
  const builtin_interfaces_msg_dds__Time_ now = node_stamp();
  const double t = now.sec + 1e-9 * now.nanosec - seconds;
  const builtin_interfaces_msg_dds__Time_ then = {(int32_t)t, (uint32_t)((t - floor(t)) * 1e9)};
  return then;
}

static void send_frame(dds_entity_t writer) {
  geometry_msgs_msg_dds__TransformStamped_ mount;
  memset(&mount, 0, sizeof mount);
  mount.header.frame_id = "base_link";
  mount.child_frame_id = "os_lidar";
  mount.transform.translation.z = 0.6;
  mount.transform.rotation.w = 1;
  tf2_msgs_msg_dds__TFMessage_ transforms;
  memset(&transforms, 0, sizeof transforms);
  transforms.transforms._buffer = &mount;
  transforms.transforms._length = transforms.transforms._maximum = 1;
  dds_write(writer, &transforms);
}

static void send_odometry(dds_entity_t writer) {
  nav_msgs_msg_dds__Odometry_ here;
  memset(&here, 0, sizeof here);
  here.header.frame_id = "odom";
  here.child_frame_id = "base_link";
  here.header.stamp = node_stamp();
  here.pose.pose.position.x = x;
  here.pose.pose.position.y = y;
  here.pose.pose.orientation.z = is("quat", "zero") ? 0 : sin(yaw / 2);
  here.pose.pose.orientation.w = is("quat", "zero") ? 0 : cos(yaw / 2);
  here.twist.twist = told.twist;
  here.twist.twist.angular.z += spin;
  dds_write(writer, &here);
}

static void send_inertia(dds_entity_t writer) {
  sensor_msgs_msg_dds__Imu_ imu;
  memset(&imu, 0, sizeof imu);
  if (!is("imu", "zero")) imu.header.stamp = node_stamp();
  imu.header.frame_id = "imu";
  imu.orientation_covariance[0] = -1;
  imu.angular_velocity.z = turn();
  imu.linear_acceleration.z = 9.81;
  dds_write(writer, &imu);
}

static void send_charge(dds_entity_t writer) {
  sensor_msgs_msg_dds__BatteryState_ battery;
  memset(&battery, 0, sizeof battery);
  battery.percentage = (float)atof(option("battery", "0"));
  battery.voltage = 24;
  battery.present = true;
  battery.location = battery.serial_number = "";
  dds_write(writer, &battery);
}

static void send_request(dds_entity_t writer, bool stamped) {
  geometry_msgs_msg_dds__TwistStamped_ request;
  memset(&request, 0, sizeof request);
  request.header.stamp = node_stamp();
  request.header.frame_id = "base_link";
  request.twist.linear.x = 0.3;
  if (stamped)
    dds_write(writer, &request);
  else
    dds_write(writer, &request.twist);
}

static void send_planar(dds_entity_t writer) {
  enum { kRays = 720 };
  static float ranges[kRays];
  sensor_msgs_msg_dds__LaserScan_ scan;
  memset(&scan, 0, sizeof scan);
  scan.header.stamp = ago(0.1);
  scan.header.frame_id = "base_link";
  scan.angle_increment = (float)(2 * M_PI / kRays);
  scan.angle_max = (float)(2 * M_PI * (kRays - 1) / kRays);
  scan.range_min = 0.1f;
  scan.range_max = 30;
  scan.scan_time = is("scan", "ns") ? 1e8f : 0.1f;
  scan.time_increment = scan.scan_time / kRays;
  for (int i = 0; i < kRays; ++i) {
    const double a = 2 * M_PI * i / kRays + yaw - turn() * (0.1 - 0.1 * i / kRays);
    ranges[i] = (float)cast(cos(a), sin(a), 0);
  }
  scan.ranges._buffer = ranges;
  scan.ranges._length = scan.ranges._maximum = kRays;
  dds_write(writer, &scan);
}

static void send_cloud(dds_entity_t writer) {
  const bool hesai = is("layout", "hesai"), livox = is("layout", "livox"), ouster = !hesai && !livox;
  const Field *from = hesai ? kHesai : livox ? kLivox : kOuster;
  const uint32_t field_count = hesai ? 6 : livox ? 7 : 9, step = ouster ? kMostStep : 26;
  sensor_msgs_msg_dds__PointField_ fields[9];
  for (uint32_t i = 0; i < field_count; ++i) {
    const sensor_msgs_msg_dds__PointField_ field = {(char *)from[i].name, from[i].offset, from[i].type, 1};
    fields[i] = field;
  }
  static uint8_t data[kRings * kColumns * kMostStep];
  memset(data, 0, sizeof data);
  sensor_msgs_msg_dds__PointCloud2_ cloud;
  memset(&cloud, 0, sizeof cloud);
  cloud.header.frame_id = (char *)option("frame", "lidar");
  cloud.header.stamp = ago(0.1); /* The sweep began 0.1 s ago. */
  cloud.height = kRings;
  cloud.width = kColumns;
  cloud.fields._buffer = fields;
  cloud.fields._length = cloud.fields._maximum = field_count;
  cloud.point_step = step;
  cloud.row_step = step * kColumns;
  cloud.data._buffer = data;
  cloud.data._length = cloud.data._maximum = step * kRings * kColumns;
  const double stamp = cloud.header.stamp.sec + 1e-9 * cloud.header.stamp.nanosec;
  const int lost = atoi(option("lost", "0"));
  for (int c = 0; c < kColumns; ++c)
    for (int r = 0; r < kRings; ++r) {
      uint8_t *at = data + (size_t)step * (size_t)(r * kColumns + c);
      const double azimuth = c * 2 * M_PI / kColumns, up = (-15 + 2 * r) * M_PI / 180, t = 0.1 * c / kColumns;
      const double a = azimuth + yaw - turn() * (0.1 - t);
      const double range = c < lost ? 0 : cast(cos(up) * cos(a), cos(up) * sin(a), sin(up));
      const float xyz[3] = {(float)(range * cos(up) * cos(azimuth)), (float)(range * cos(up) * sin(azimuth)),
                            (float)(range * sin(up))};
      memcpy(at, xyz, sizeof xyz);
      const bool zero = c < lost && is("lost_time", "zero"), wrapped = c < lost && is("lost_time", "wrapped");
      const uint32_t ns = zero ? 0u : wrapped ? 0u - (uint32_t)stamp : (uint32_t)(t * 1e9);
      const double since_1970 = zero || wrapped ? 0 : (stamp + t) * (livox ? 1e9 : 1);
      if (ouster)
        memcpy(at + 20, &ns, sizeof ns);
      else
        memcpy(at + 18, &since_1970, sizeof since_1970);
    }
  dds_write(writer, &cloud);
}

/* A writer as ROS 2's static broadcaster has it: reliable, transient local, depth 1. */
static dds_entity_t latched_writer(dds_entity_t node, const char *topic, const dds_topic_descriptor_t *type) {
  dds_qos_t *qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
  const dds_entity_t writer = dds_create_writer(node, dds_create_topic(node, type, topic, NULL, NULL), qos, NULL);
  dds_delete_qos(qos);
  return writer;
}

int main(int argc, char **argv) {
  count = argc;
  words = argv;
  const dds_entity_t node = node_open(option("domain", "7"));
  const bool stamped = is("velocity", "stamped"), external_stamped = is("external", "stamped");
  const dds_topic_descriptor_t *twist = &geometry_msgs_msg_dds__Twist__desc;
  const dds_topic_descriptor_t *twist_stamped = &geometry_msgs_msg_dds__TwistStamped__desc;
  const dds_entity_t cmd_vel = node_reader(node, "rt/cmd_vel", stamped ? twist_stamped : twist);
  const dds_entity_t odometry = node_writer(node, "rt/odom", &nav_msgs_msg_dds__Odometry__desc, false);
  const dds_entity_t points = node_writer(node, "rt/points", &sensor_msgs_msg_dds__PointCloud2__desc, false);
  const dds_entity_t scans = node_writer(node, "rt/scan", &sensor_msgs_msg_dds__LaserScan__desc, false);
  const dds_entity_t imu = node_writer(node, "rt/imu/data", &sensor_msgs_msg_dds__Imu__desc, false);
  const dds_entity_t battery = node_writer(node, "rt/battery_state", &sensor_msgs_msg_dds__BatteryState__desc, true);
  const dds_entity_t external =
      is("external", "none")
          ? 0
          : node_writer(node, "rt/external/cmd_vel", external_stamped ? twist_stamped : twist, true);
  const dds_entity_t tf = latched_writer(node, "rt/tf_static", &tf2_msgs_msg_dds__TFMessage__desc);

  double tf_at = atof(option("tf_at", "-1"));
  const double seconds = atof(option("seconds", "60"));
  spin = atof(option("spin", "0"));
  memset(&told, 0, sizeof told);
  long silent = 0; /* ms */
  for (long k = 0; node_rate(10) && 0.01 * (double)k < seconds; ++k) {
    const double now = 0.01 * (double)k;
    const bool heard = stamped ? node_newest(cmd_vel, &told) : node_newest(cmd_vel, &told.twist);
    silent = heard ? 0 : silent + 10;
    if (silent > 500) memset(&told.twist, 0, sizeof told.twist);
    x += 0.01 * told.twist.linear.x * cos(yaw);
    y += 0.01 * told.twist.linear.x * sin(yaw);
    yaw += 0.01 * turn();
    if (tf_at >= 0 && now >= tf_at) send_frame(tf), tf_at = -1;
    if (k % 2 == 0) send_odometry(odometry);
    if (!is("imu", "none")) send_inertia(imu);
    if (external && k % 5 == 0) send_request(external, external_stamped);
    if (!is("battery", "none") && k % 50 == 0) send_charge(battery);
    if (k % 10 == 0 && !is("scan", "none")) send_planar(scans);
    if (k % 10 == 0 && strcmp(option("layout", "ouster"), "none")) send_cloud(points);
    if (k == 0) printf("drives\n"), fflush(stdout);
  }
  return 0;
}
