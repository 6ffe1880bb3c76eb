/* What a small ROS 2 node needs of Cyclone DDS: a participant on the loopback alone, readers, writers, a clock. */
#ifndef NODE_H
#define NODE_H
#include <dds/dds.h>
#include <stdbool.h>

#include "ros.h"

/* Ends the program with a sentence when something cannot be had. */
dds_entity_t node_open(const char *domain);
/* depth 1; best effort unless `reliable`. Topics are DDS names: "rt/cmd_vel". */
dds_entity_t node_writer(dds_entity_t node, const char *topic, const dds_topic_descriptor_t *type, bool reliable);
dds_entity_t node_reader(dds_entity_t node, const char *topic, const dds_topic_descriptor_t *type);
/* The newest sample into `sample` (its memory is the caller's); false: none has come. */
bool node_newest(dds_entity_t reader, void *sample);
builtin_interfaces_msg_dds__Time_ node_stamp(void);
/* Waits until the next period of `ms`; false when the program is to end. */
bool node_rate(long ms);
#endif
