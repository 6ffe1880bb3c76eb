/* A robot's driver in place of the simulator, as one would write it: reads /cmd_vel, stops by itself when that falls
   silent, answers /odom (50 Hz) and /points (10 Hz; an empty plain). usage: ros_driver DOMAIN */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "node.h"

enum { kRings = 3, kSpokes = 180, kPoints = kRings * kSpokes };

static sensor_msgs_msg_dds__PointCloud2_ plain(void) {
  static float xyz[kPoints][3];
  static sensor_msgs_msg_dds__PointField_ fields[3];
  static const float rings[kRings] = {1.0f, 2.0f, 4.0f};
  static char *names[3] = {"x", "y", "z"};
  for (int i = 0; i < kPoints; ++i) {
    const double angle = i % kSpokes * (2.0 * M_PI / kSpokes);
    xyz[i][0] = rings[i / kSpokes] * (float)cos(angle);
    xyz[i][1] = rings[i / kSpokes] * (float)sin(angle);
  }
  for (int i = 0; i < 3; ++i) {
    const sensor_msgs_msg_dds__PointField_ field = {names[i], (uint32_t)(4 * i), 7 /* FLOAT32 */, 1};
    fields[i] = field;
  }
  sensor_msgs_msg_dds__PointCloud2_ cloud;
  memset(&cloud, 0, sizeof cloud);
  cloud.header.frame_id = "base_link";
  cloud.height = 1;
  cloud.width = kPoints;
  cloud.fields._buffer = fields;
  cloud.fields._length = cloud.fields._maximum = 3;
  cloud.point_step = sizeof xyz[0];
  cloud.row_step = sizeof xyz;
  cloud.data._buffer = (uint8_t *)xyz;
  cloud.data._length = cloud.data._maximum = sizeof xyz;
  cloud.is_dense = true;
  return cloud;
}

int main(int argc, char **argv) {
  if (argc != 2) return fprintf(stderr, "usage: ros_driver DOMAIN\n"), 2;
  const dds_entity_t node = node_open(argv[1]);
  const dds_entity_t cmd_vel = node_reader(node, "rt/cmd_vel", &geometry_msgs_msg_dds__Twist__desc);
  const dds_entity_t odom = node_writer(node, "rt/odom", &nav_msgs_msg_dds__Odometry__desc, false);
  const dds_entity_t points = node_writer(node, "rt/points", &sensor_msgs_msg_dds__PointCloud2__desc, false);

  sensor_msgs_msg_dds__PointCloud2_ cloud = plain();
  nav_msgs_msg_dds__Odometry_ here;
  memset(&here, 0, sizeof here);
  here.header.frame_id = "odom";
  here.child_frame_id = "base_link";
  geometry_msgs_msg_dds__Twist_ told;
  memset(&told, 0, sizeof told);

  const long period = 20;
  double x = 0, y = 0, yaw = 0;
  long silent = 0;
  for (long step = 0; node_rate(period); ++step) {
    silent = node_newest(cmd_vel, &told) ? 0 : silent + period;
    if (silent > 500) memset(&told, 0, sizeof told); /* the driver's own watchdog */
    const double dt = 1e-3 * (double)period;
    x += dt * (told.linear.x * cos(yaw) - told.linear.y * sin(yaw));
    y += dt * (told.linear.x * sin(yaw) + told.linear.y * cos(yaw));
    yaw += dt * told.angular.z;
    here.header.stamp = node_stamp();
    here.pose.pose.position.x = x;
    here.pose.pose.position.y = y;
    here.pose.pose.orientation.z = sin(yaw / 2);
    here.pose.pose.orientation.w = cos(yaw / 2);
    here.twist.twist = told;
    dds_write(odom, &here);
    if (step % 5 != 0) continue;
    cloud.header.stamp = node_stamp();
    dds_write(points, &cloud);
  }
  return 0;
}
