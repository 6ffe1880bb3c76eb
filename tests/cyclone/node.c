#include "node.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static volatile sig_atomic_t ended;

static void end(int number) {
  (void)number;
  ended = 1;
}

static dds_entity_t need(dds_entity_t made, const char *what) {
  if (made >= 0) return made;
  fprintf(stderr, "%s: %s\n", what, dds_strretcode(-made));
  exit(1);
}

dds_entity_t node_open(const char *domain) {
  const int number = atoi(domain);
  signal(SIGTERM, end);
  signal(SIGINT, end);
  /* The loopback and nothing else. */
  need(dds_create_domain((dds_domainid_t)number,
                         "<Domain><General><Interfaces><NetworkInterface name=\"lo\" multicast=\"true\"/></Interfaces>"
                         "<AllowMulticast>true</AllowMulticast></General></Domain>"),
       "domain");
  return need(dds_create_participant((dds_domainid_t)number, NULL, NULL), "participant");
}

static dds_qos_t *qos(bool reliable) {
  dds_qos_t *q = dds_create_qos();
  dds_qset_reliability(q, reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, DDS_MSECS(100));
  dds_qset_history(q, DDS_HISTORY_KEEP_LAST, 1);
  return q;
}

dds_entity_t node_writer(dds_entity_t node, const char *topic, const dds_topic_descriptor_t *type, bool reliable) {
  dds_qos_t *q = qos(reliable);
  const dds_entity_t writer =
      need(dds_create_writer(node, need(dds_create_topic(node, type, topic, NULL, NULL), topic), q, NULL), topic);
  dds_delete_qos(q);
  return writer;
}

dds_entity_t node_reader(dds_entity_t node, const char *topic, const dds_topic_descriptor_t *type) {
  dds_qos_t *q = qos(false);
  const dds_entity_t reader =
      need(dds_create_reader(node, need(dds_create_topic(node, type, topic, NULL, NULL), topic), q, NULL), topic);
  dds_delete_qos(q);
  return reader;
}

bool node_newest(dds_entity_t reader, void *sample) {
  dds_sample_info_t info;
  bool any = false;
  while (dds_take(reader, &sample, &info, 1, 1) > 0) any = any || info.valid_data;
  return any;
}

builtin_interfaces_msg_dds__Time_ node_stamp(void) {
  const dds_time_t now = dds_time();
  builtin_interfaces_msg_dds__Time_ stamp = {(int32_t)(now / 1000000000), (uint32_t)(now % 1000000000)};
  return stamp;
}

bool node_rate(long ms) {
  const struct timespec period = {ms / 1000, ms % 1000 * 1000000};
  nanosleep(&period, NULL);
  return !ended;
}
