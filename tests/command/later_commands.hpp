// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/command/parse.hpp"

namespace adit::command {

constexpr Argument keyword(std::string_view name) { return {.name = name, .type = Type::keyword}; }
constexpr Argument a_name(std::string_view name, std::string_view what) {
  return {.name = name, .type = Type::name, .what = what};
}
constexpr Argument a_number(std::string_view name, double minimum = -kMaxDistance) {
  return {.name = name, .type = Type::number, .minimum = minimum, .maximum = kMaxDistance};
}
constexpr Argument a_choice(std::string_view name, std::string_view choices) {
  return {.name = name, .type = Type::choice, .what = "a choice", .choices = choices};
}
constexpr Argument a_file(std::string_view name) {
  return {.name = name, .type = Type::file, .what = "a file"};
}

/// Commands of every shape that a mission may need: keywords, polygons, options with values, several robots.
inline constexpr std::array kLater{
    CommandInfo{.name = "yield", .arguments = {kRobots, a_choice("STATE", "on|off")}, .number = 20},
    CommandInfo{.name = "explore",
                .arguments = {kRobots},
                .options = {Option{.name = "--area", .values = {a_name("NAME", "an area")}},
                            Option{.name = "--after", .values = {a_choice("THEN", "report|home|wait")}},
                            Option{.name = "--for", .values = {a_number("SECONDS", 0)}}},
                .number = 21},
    CommandInfo{.name = "area add",
                .arguments = {kRobots, keyword("add"), a_name("NAME", "an area"),
                              a_choice("KIND", "keep_in|keep_out|prefer"),
                              Argument{.name = "X Y",
                                       .type = Type::number,
                                       .minimum = -kMaxDistance,
                                       .maximum = kMaxDistance,
                                       .min_count = 2,
                                       .max_count = 16,
                                       .group = 2}},
                .options = {Option{.name = "--z", .values = {a_number("Z0"), a_number("Z1")}},
                            Option{.name = "--weight", .values = {a_number("W")}}},
                .number = 22},
    CommandInfo{.name = "area remove",
                .arguments = {kRobots, keyword("remove"), a_name("NAME", "an area")},
                .number = 23},
    CommandInfo{.name = "convoy start",
                .arguments = {keyword("start"), Argument{.name = "R",
                                                         .type = Type::robots,
                                                         .what = "a robot",
                                                         .min_count = 2,
                                                         .max_count = kMaxRobots}},
                .options = {Option{.name = "--gap", .values = {a_number("M")}},
                            Option{.name = "--speed", .values = {a_number("V")}}},
                .number = 24},
    CommandInfo{.name = "convoy stop", .arguments = {keyword("stop"), kRobot}, .number = 25},
    CommandInfo{.name = "map save",
                .arguments = {keyword("save"), a_file("FILE")},
                .options = {Option{.name = "--robot", .values = {a_name("R", "a robot")}},
                            Option{.name = "--floor", .values = {a_number("N")}},
                            Option{.name = "--resolution", .values = {a_number("M", 0)}}},
                .runs = Runs::station},
    CommandInfo{.name = "map load", .arguments = {keyword("load"), a_file("FILE")}, .runs = Runs::station},
    CommandInfo{.name = "map status", .arguments = {keyword("status")}, .runs = Runs::query},
    CommandInfo{.name = "camera shot", .arguments = {kRobot, keyword("shot"), a_file("FILE")}, .number = 26},
    CommandInfo{.name = "camera", .arguments = {kRobot, a_choice("STATE", "on|off")}, .number = 27},
    CommandInfo{
        .name = "goto",
        .arguments = {kRobot, a_number("X"), a_number("Y"),
                      Argument{.name = "Z", .type = Type::number, .min_count = 0}},
        .options = {Option{.name = "--nearest"},
                    Option{.name = "--budget",
                           .values = {Argument{
                               .name = "M", .type = Type::number, .minimum = 0, .unlimited = "none"}}}},
        .number = 28},
};

}  // namespace adit::command
