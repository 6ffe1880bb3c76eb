// SPDX-License-Identifier: Apache-2.0
#include "robot_agent/notices/notices.hpp"

#include <cmath>
#include <cstdio>

namespace adit::agent {

Notices::Notices(std::string robot, Notifier& notifier, Log log, std::function<std::string()> holder)
    : robot_(std::move(robot)), notifier_(notifier), log_(std::move(log)), holder_(std::move(holder)) {}

void Notices::send(const Notice& notice) const {
  if (log_.on(LogLevel::info))
    log_.info("notice to " + (notice.operator_name.empty() ? "everybody" : notice.operator_name) + " " +
              notice.code + ": " + notice.text);
  notifier_.send(notice);
}

void Notices::to_holder(Severity severity, const std::string& code, Reason reason,
                        const std::string& text) const {
  if (const std::string holder = holder_(); !holder.empty()) send({holder, severity, code, reason, text});
}

void Notices::restored(const Restored& found, bool same_boot) const {
  if (found.lost)
    to_all(Severity::error, "state_lost", Reason::cannot_read,
           robot_ + " started and holds, stopped: its state was lost (" + found.text +
               "), and with it any stop; check that it may move, then: reset " + robot_ + " --override");
  else if (found.snapshot)
    to_all(Severity::warning, "restarted", Reason::none,
           robot_ + " was restarted: " + describe(*found.snapshot) +
               (found.placed ? "; its start says where it is, so it holds"
                : same_boot  ? ""
                             : "; with its computer, so it holds"));
  if (found.damaged)
    to_all(Severity::error, "state_damaged", Reason::cannot_read,
           robot_ + (found.hold ? " holds: " : ": ") + "its state was damaged (" + found.text + ")");
}

void Notices::tree_refused(const std::string& why) const {
  to_all(Severity::error, "tree_refused", Reason::tree_refused, robot_ + " runs in hold: " + why);
}

void Notices::namesake(const wire::ParticipantId& other, bool gives_way) const {
  const std::string who =
      "another robot, participant " + wire::to_string(other) + ", calls itself " + robot_ + ": ";
  to_all(gives_way ? Severity::error : Severity::warning, "name_taken", Reason::name_taken,
         who + (gives_way ? "this one came later, holds and refuses commands; give it a name of its own"
                          : "this one was first and stays in service; give the other one a name of its own"));
}

void Notices::announcement_refused(const std::string& name, const std::string& why) const {
  to_holder(Severity::warning, "announcement_refused", Reason::out_of_range,
            name + " announces a " + why + "; " + robot_ + " ignores it: correct the file of " + name);
}

void Notices::rival(const wire::ParticipantId& writer) const {
  to_all(Severity::error, "rival_writer", Reason::none,
         "participant " + wire::to_string(writer) + " writes velocities to the driver of " + robot_ +
             " beside its agent: end that program, neither is obeyed as long as both write");
}

void Notices::odometry_jumped(const Pose2& guess) const {
  char place[64];
  std::snprintf(place, sizeof place, "%.1f %.1f %.2f", guess.x, guess.y, guess.yaw);
  to_all(Severity::error, "odometry_jumped", Reason::odometry_jumped,
         "the odometry of " + robot_ +
             " jumped: it holds with an empty local map, and assumes that it is at " + place +
             "; check that, and set it by: pose " + robot_ + " X Y YAW");
}

void Notices::not_localised_here(const Pose2& guess, const std::string& why) const {
  char place[64];
  std::snprintf(place, sizeof place, "%.1f %.1f %.2f", guess.x, guess.y, guess.yaw);
  to_all(Severity::error, "not_localised_here", Reason::not_localised_here,
         robot_ + " was started again and does not recognise its surroundings (" + why +
             "): it holds; it was at " + place + "; set where it is by: pose " + robot_ + " X Y YAW");
}

void Notices::localisation(Localisation health, double sigma) const {
  char known[48];
  std::snprintf(known, sizeof known, "%.2f m", sigma);
  if (health == Localisation::lost)
    to_holder(Severity::error, "localisation_lost", Reason::localisation_lost,
              robot_ +
                  " is lost: what its lidar sees does not fit what it saw before; only its wheels or "
                  "legs carry its pose on");
  else if (health == Localisation::weak)
    to_holder(Severity::warning, "localisation_weak", Reason::none,
              robot_ +
                  " sees nothing that tells its place along its way, and relies on its wheels or legs; its "
                  "place is known to " +
                  known);
  else
    to_holder(Severity::info, "localisation_ok", Reason::none,
              robot_ + " knows its place again, to " + known);
}

void Notices::place_not_searched(double radius) const {
  to_holder(Severity::error, "place_not_searched", Reason::localisation_lost,
            robot_ + " is lost and may be more than " + std::to_string(std::lround(radius)) +
                " m from where it was: it does not search for its place any more; set where it is by: pose " +
                robot_ + " X Y YAW");
}

void Notices::wheels_slip(bool flies) const {
  to_holder(Severity::warning, "wheels_slip", Reason::none,
            flies ? "the driver of " + robot_ + " reports a motion that its lidar does not see"
                  : "the wheels or legs of " + robot_ +
                        " move and its body does not follow: the ground is loose, or something holds it");
}

void Notices::stuck() const {
  to_holder(
      Severity::warning, "stuck", Reason::stuck,
      robot_ + " pushed for 5 s without moving, and holds: drive it free by hand, or send it another way");
}

void Notices::driver_lost() const {
  to_holder(Severity::error, "driver_lost", Reason::driver_silent, "the driver of " + robot_ + " is silent");
}

void Notices::warning(Warning warning, bool stops) const {
  if (warning == Warning::lidar_silent)
    to_holder(Severity::warning, "lidar_silent", Reason::terrain_stale,
              "the lidar of " + robot_ + " is silent: it drives blindly, at most 0.3 m/s");
  else if (warning == Warning::outside_area)
    to_holder(Severity::warning, "outside_area", Reason::outside_area,
              robot_ +
                  " is where its areas forbid it to be; an autonomous mode drives it back from up to 1 m "
                  "inside, from farther you do, by hand");
  else if (warning == Warning::tilted)
    to_holder(
        Severity::error, "tilted", Reason::tilted,
        robot_ + " leans so far that it may tip over: it stands, and in manual it drives at most 0.3 m/s");
  else
    to_holder(Severity::warning, "obstacle_near", Reason::none,
              "something is in the way of " + robot_ +
                  (stops ? ": it slows down and stops" : ": it slows down to 0.3 m/s and does not stop"));
}

}  // namespace adit::agent
