/* A planner from outside: drives to x by what /odom says, through the topic it is told to write.
   usage: ros_planner DOMAIN X [TOPIC]   (TOPIC: rt/external/cmd_vel, what the mode `external` listens to) */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "node.h"

int main(int argc, char **argv) {
  if (argc < 3 || argc > 4) return fprintf(stderr, "usage: ros_planner DOMAIN X [TOPIC]\n"), 2;
  const dds_entity_t node = node_open(argv[1]);
  const double goal = atof(argv[2]);
  const char *topic = argc > 3 ? argv[3] : "rt/external/cmd_vel";
  const dds_entity_t odom = node_reader(node, "rt/odom", &nav_msgs_msg_dds__Odometry__desc);
  const dds_entity_t cmd_vel = node_writer(node, topic, &geometry_msgs_msg_dds__Twist__desc, true);

  nav_msgs_msg_dds__Odometry_ here;
  memset(&here, 0, sizeof here);
  bool known = false;
  while (node_rate(50)) {
    known = node_newest(odom, &here) || known;
    geometry_msgs_msg_dds__Twist_ velocity;
    memset(&velocity, 0, sizeof velocity);
    if (known) velocity.linear.x = fmax(-0.5, fmin(0.5, goal - here.pose.pose.position.x));
    dds_write(cmd_vel, &velocity);
  }
  return 0;
}
