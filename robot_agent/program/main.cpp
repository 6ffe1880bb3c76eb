// SPDX-License-Identifier: Apache-2.0
// robot_agent: one agent on one robot. See robot_agent/README.md.
#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cctype>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include "core/config/search.hpp"
#include "core/config/usage.hpp"
#include "core/exec/live_runtime.hpp"
#include "core/record/flight_recorder.hpp"
#include "core/store/file_disk.hpp"
#include "core/wire/link_file.hpp"
#include "perception/vision/vision_detector.hpp"
#include "robot_agent/agent.hpp"
#include "robot_agent/common/console_answer.hpp"
#include "robot_agent/program/check.hpp"
#include "robot_agent/program/console.hpp"
#include "robot_agent/program/memory_limit.hpp"
#include "robot_agent/program/parent.hpp"
#include "robot_agent/program/robot_config.hpp"
#include "robot_agent/program/service.hpp"
#include "robot_agent/program/zero.hpp"

namespace {

using namespace adit;
using namespace adit::agent;

constexpr int kBeatsOfStart = 40;  // 2 s at 20 Hz: by then planner and sensors exist as well.

constexpr const char* kExamples = R"(
Examples:
  robot_agent --config config/robots/r1.yaml             the robot of that file
  robot_agent --config config/robots/r1.yaml --supervised  restarted when it dies; zero is sent meanwhile
  robot_agent --config config/robots/r1.yaml --name r7 --pose 4 2 1.57 --robot-domain 7
  robot_agent check --config r1.yaml                     judge the mounted sensors, before the first drive
  robot_agent console status --name r1                   at the robot itself
  robot_agent console unlock --name r1                   end the lock of an operator who is gone
  robot_agent console restart planner --name r1          make a component anew

Exit status: 0 ended by a signal, 1 failed, 2 wrong usage or configuration. Of `check`: 0 all is OK, 1 something is
wrong. Of `console`: 0 done, 1 refused, 2 wrong usage, 3 no answer.)";

constexpr const char* kCheckFooter = R"(
It listens to the drivers and sends nothing. Let the robot stand on level ground for 10 s, then turn it on the spot by
its own remote control. Each line is OK or wrong, with the line of the file to change: rates, delays, clocks, frames,
height and tilt of the lidars against the ground, gravity and its axis, the gyro's sign, socket buffers.

Exit status: 0 all is OK, 1 something is wrong, 2 wrong usage or configuration.)";

struct Options {
  std::string config{}, name{}, perception{}, state{}, log{}, link{}, record{};
  std::vector<double> pose{};
  int domain{-1}, robot_domain{-1};
  double memory_limit{-1.0}, good_run{10.0};
  bool supervised{}, reports{}, placed{}, allow_faults{};
};

int fail(const Error& error, int code) {
  std::cerr << "robot_agent: " << error.text << "\n";
  return code;
}

Result<RobotConfig> load(const Options& options) {
  // Tries the path as given, then the configuration's search path.
  const auto file = config::find_file(options.config, "./");
  if (!file) return file.error();
  auto config = load_robot_config(*file);
  if (!config) return config;
  if (!options.name.empty()) config->name = config->radio.name = options.name;
  if (!command::valid_robot_name(config->name))
    return Error{Reason::bad_argument,
                 std::string("a robot's name is ") + command::kRobotName + ": '" + config->name + "'"};
  if (!options.pose.empty()) config->start = {options.pose[0], options.pose[1], options.pose[2]};
  if (options.pose.size() > 3) config->start_height = options.pose[3];
  if (!options.perception.empty()) config->perception = perception_level(options.perception);
  if (options.domain >= 0) config->radio.domain = static_cast<std::uint32_t>(options.domain);
  if (options.robot_domain >= 0) config->robot_domain = static_cast<std::uint32_t>(options.robot_domain);
  if (!options.link.empty()) {
    auto link = wire::load_link(options.link);
    if (!link) return Error{Reason::bad_argument, "--link: " + link.error().text};
    config->radio.link = std::move(*link);
  }
  if (!options.state.empty()) config->state = options.state;
  if (options.memory_limit >= 0.0) config->memory_limit = options.memory_limit;
  if (!options.log.empty() && !level_from_name(options.log, config->log))
    return Error{Reason::bad_argument, "--log is trace, debug, info, warn, error or off"};
  if (!options.record.empty()) config->record = options.record;
  return config;
}

Result<wire::FastDdsParams> robot_wire(const RobotConfig& config) {
  wire::FastDdsParams params{};
  auto addresses = addresses_of(config.robot_interfaces);
  if (!addresses) return addresses.error();
  params.interfaces = std::move(*addresses);
  params.domain = config.robot_domain;
  params.name = config.name;
  params.large_samples = true;
  return params;
}

std::uint64_t drawn_seed() {
  std::uint64_t seed{};
  while (::getrandom(&seed, sizeof seed, 0) != sizeof seed) {
  }
  return seed;
}

/// Id of the computer's boot, after which odometry starts again; 0: unknown.
std::uint64_t this_boot() {
  std::ifstream file("/proc/sys/kernel/random/boot_id");
  std::string text;
  std::getline(file, text);
  std::uint64_t value = 0;
  for (const char c : text)
    if (std::isxdigit(static_cast<unsigned char>(c)) != 0)
      value = (value << 4 | value >> 60) ^ static_cast<std::uint64_t>(c);
  return value;
}

sigset_t end_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  return set;
}

/// Executes a line of the robot's console that only --allow-faults permits, and returns the answer.
std::string inject(agent::Agent& agent, const std::string& line) {
  std::istringstream words(line);
  std::string verb, fault, component;
  words >> verb >> fault >> component;
  if (fault != "crash" && fault != "hang") return refused_at_console("fault crash|hang COMPONENT");
  const auto done = agent.inject(component, fault == "hang" ? ComponentFault::hang : ComponentFault::crash);
  return done ? "done\n" : refused_at_console(done.error().text);
}

/// Sets the memory limit once all components exist; a limit that is too low is a configuration error.
void bound_memory(double limit) {
  const auto bounded = limit_memory(limit);
  if (!bounded) std::_Exit(fail(bounded.error(), 2));
}

/// Ends the process after 3 s at the latest, so that a component that hangs does not delay its end.
void end_soon() {
  (void)::signal(SIGALRM, [](int) { std::_Exit(0); });
  ::alarm(3);
}

int run_agent(const RobotConfig& config, const Options& options) {
  auto log = make_live_log({config.log});
  if (!log) return fail(log.error(), 1);
  const auto inner = robot_wire(config);
  if (!inner) return fail(inner.error(), 2);
  // A detector of objects takes tenths of a second: other computations do not wait for it.
  LiveRuntime runtime({.compute_threads = config.objects ? 2 : 1});
  auto over = config.radio;
  over.link_seed = drawn_seed();
  auto radio = wire::open_fastdds(over);
  if (!radio) return fail(radio.error(), 1);
  auto robot = wire::open_fastdds(*inner);
  if (!robot) return fail(robot.error(), 1);
  record::FlightRecorder flight_recorder(
      {.folder = config.record,
       .name = config.name,
       .about = {{"kind", "robot"}, {"software", ADIT_VERSION}},
       .on_error = [log = *log, name = config.name](const std::string& text) { Log(log, name).warn(text); }});

  AgentParams params = agent_params(config);
  params.make_detector = perception::make_vision_detector;
  // A child that its parent restarted goes on from where it was.
  params.start_given = !options.pose.empty() && (!options.reports || options.placed);
  params.seed = drawn_seed();
  params.log = flight_recorder.tap(*log);
  params.boot = this_boot();
  if (const std::string folder = state_folder(config); !folder.empty()) {
    auto disk = store::FileDisk::open(folder);
    if (!disk)
      return fail({disk.reason(), disk.error().text + " (state: FOLDER, or none to keep nothing)"}, 2);
    params.disk = std::move(*disk);
  }
  params.end = [log = Log(params.log, config.name)](const std::string& why) {
    log.error(why + "; ending to be started anew");
    std::_Exit(kEscalatedExit);
  };
  const agent::Service service = agent::Service::from_environment();
  params.alive = [service, reports = options.reports, limit = config.memory_limit, ready = false,
                  beats = 0]() mutable {
    if (reports) (void)!::write(kReportFd, "1", 1);
    if (!std::exchange(ready, true)) service.notify("READY=1");
    if (beats++ % 10 == 0) service.notify("WATCHDOG=1");
    if (beats == kBeatsOfStart) bound_memory(limit);
  };
  agent::Agent agent(params, runtime, flight_recorder.tap(**radio, "radio"),
                     flight_recorder.tap(**robot, "robot"));
  // The console's socket also prevents two agents with one name on this computer.
  std::atomic<bool> up{false};
  const bool faults = options.allow_faults;
  auto console = Console::open(config.name, [&agent, &up, faults](const std::string& line, auto answer) {
    if (!up)
      answer(refused_at_console("it is starting"));
    else if (faults && line.starts_with("fault "))
      answer(inject(agent, line));
    else
      agent.at_console(line, std::move(answer));
  });
  if (!console) return fail(console.error(), 2);
  if (const auto started = agent.start(); !started) return fail(started.error(), 1);
  up = true;
  Log(params.log, config.name)
      .info("up on radio domain " + std::to_string(config.radio.domain) + ", robot domain " +
            std::to_string(config.robot_domain));
  const sigset_t set = end_signals();
  int number = 0;
  sigwait(&set, &number);
  service.notify("STOPPING=1");
  end_soon();
  console->reset();
  if (runtime.left_behind() > 0) std::_Exit(0);  // Threads that hang would access destroyed objects.
  return 0;
}

int run_parent(const RobotConfig& config, const Options& options, int argc, char** argv) {
  const auto inner = robot_wire(config);
  if (!inner) return fail(inner.error(), 2);
  ParentParams params{};
  params.good_run = from_seconds(options.good_run);
  params.command.push_back("robot_agent");
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) != "--supervised") params.command.push_back(argv[i]);
  params.command.push_back("--reports");
  params.at_first = {"--placed"};
  ZeroSender zero;
  Parent parent(
      params,
      [&] {
        if (const auto opened = zero.open(*inner, config.velocity); !opened)
          std::cerr << "robot_agent: the parent cannot send zero: " << opened.error().text << "\n";
      },
      [&] { zero.send(); });
  return parent.run();
}

int ask(const std::string& name, const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  const auto answer = ask_console(name, line);
  if (!answer) return fail(answer.error(), answer.reason() == Reason::no_answer ? 3 : 1);
  std::cout << *answer;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The agent of one robot: takes commands by radio and drives.", "robot_agent"};
  app.footer(kExamples);
  app.set_version_flag("--version", ADIT_VERSION);
  Options options;
  app.add_option("--config", options.config, "robot file, as config/robots/r1.yaml");
  app.add_option("--name", options.name, "another name than the file's");
  app.add_option(
         "--pose", options.pose,
         "where in the map the odometry begins, X Y YAW [HEIGHT]: m, m, rad, m; replaces the stored place")
      ->expected(3, 4)
      ->check(config::between(-1e4, 1e4));
  app.add_option("--perception", options.perception, "off, odometry or slam, instead of the file's")
      ->check(CLI::IsMember(kPerceptionWords));
  app.add_option("--domain", options.domain, "DDS domain of the radio")->check(config::between(0, 232));
  app.add_option("--robot-domain", options.robot_domain, "DDS domain of the driver")
      ->check(config::between(0, 232));
  app.add_option(
      "--link", options.link,
      "link profile (config/links) that all that is sent by radio keeps to: budgets, latency, loss");
  app.add_option("--state", options.state, "folder of what survives a restart, or none");
  app.add_option("--log", options.log, "trace, debug, info, warn, error or off");
  app.add_option(
      "--record", options.record,
      "folder for the recording of the last minutes, or none; below the state folder when not given");
  app.add_flag("--supervised", options.supervised, "run under a parent that sends zero when the agent dies");
  app.add_option("--memory-limit", options.memory_limit, "MB that the agent may use; 0: no limit")
      ->check(config::between(0.0, 1e6));
  app.add_flag("--allow-faults", options.allow_faults,
               "let the robot's console make components fail: fault crash|hang COMPONENT");
  // Set by the parent process: for each child, and until one has reported.
  app.add_flag("--reports", options.reports)->group("");
  app.add_flag("--placed", options.placed)->group("");
  // For measurements that kill the agent repeatedly.
  app.add_option("--good-run", options.good_run)->group("")->check(config::between(0.0, 3600.0));
  auto* console =
      app.add_subcommand("console", "the robot's own console: status, unlock, peers, health, restart");
  std::vector<std::string> words;
  std::string robot;
  console
      ->add_option("command", words,
                   "status | unlock | peers | health | restart COMPONENT | policy COMPONENT auto|manual")
      ->required();
  console->add_option("--name", robot, "the robot")->required();
  auto* check = app.add_subcommand("check", "judge the robot's sensors: 10 s of standing and one turn");
  check->footer(kCheckFooter);
  double standing = 10, turning = 60;
  bool no_turn = false;
  check->add_option("--config", options.config, "robot file, as config/robots/r1.yaml")->required();
  check->add_option("--robot-domain", options.robot_domain, "DDS domain of the driver")
      ->check(config::between(0, 232));
  check->add_option("--standing", standing, "how long it listens to the standing robot, s [10]")
      ->check(config::between(0.1, 600.0));
  check->add_option("--turning", turning, "how long it waits for the turn at most, s [60]")
      ->check(config::between(1.0, 600.0));
  check->add_flag("--no-turn", no_turn, "do not ask for a turn");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return config::end_usage(app, error);
  }
  if (*console) return ask(robot, words);
  if (options.config.empty()) return fail({Reason::bad_argument, "--config FILE is missing; see --help"}, 2);
  const auto config = load(options);
  if (!config) return fail(config.error(), 2);

  const sigset_t set = end_signals();
  if (*check) {
    const auto inner = robot_wire(*config);
    if (!inner) return fail(inner.error(), 2);
    const auto file = config::find_file(options.config, "./");
    return check_sensors(*config, *inner,
                         {*file, from_seconds(standing), no_turn ? Duration::zero() : from_seconds(turning)});
  }
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  if (options.supervised) return run_parent(*config, options, argc, argv);
  if (options.reports) prctl(PR_SET_PDEATHSIG, SIGTERM);
  return run_agent(*config, options);
}
