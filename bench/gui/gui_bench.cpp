// SPDX-License-Identifier: Apache-2.0
// What the operator's window costs and how soon it answers, without a screen and without a GPU: the machine
// with the least that it must run on. Each repeat is a process of its own.
#include <CLI/CLI.hpp>
#include <QGuiApplication>
#include <cstdio>
#include <cstdlib>

#include "bench/gui/course.hpp"
#include "tests/gui/tasks.hpp"

namespace {

using namespace adit::gui::bench;

/// The limit of a result on such a machine; 0: it is only reported.
struct Limit {
  const char* name{};
  double most{};   ///< 0: no limit.
  double least{};  ///< 0: no limit.
};
constexpr Limit kLimits[] = {
    {"start to the first card, ms", 1500, 0},
    {"memory, ten robots, MB", 130, 0},
    {"state to pixel, median, ms", 40, 0},
    {"state to pixel, 99 %, ms", 120, 0},
    {"processor, nothing changes, %", 1, 0},
    {"processor, ten robots at 10 Hz, %", 15, 0},
    {"the same, window hidden, %", 0, 0},
    {"frame in which a map of 1 M cells comes, ms", 60, 0},
    {"memory for that map, MB", 40, 0},
    {"frames per second, the map moves", 0, 25},
    {"voxels of the map, M", 0, 0},
    {"frames per second, the map in 3D moves", 0, 15},
    {"event at the station to pixel, median, ms", 40, 0},
    {"event at the station to pixel, 99 %, ms", 120, 0},
    {"tap to the station, median, ms", 0, 0},
    {"tap to the station, 99 %, ms", 20, 0},
    {"stop at finger-down to the station, median, ms", 0, 0},
    {"stop at finger-down to the station, 99 %, ms", 15, 0},
};

int measure_once(int argc, char** argv, double started) {
  ::setenv("QT_QPA_PLATFORM", "offscreen", 1);
  ::setenv("QT_QUICK_BACKEND", "software", 1);
  const QGuiApplication app(argc, argv);
  Results results = window_results(started);
  for (const auto& result : socket_results()) results.push_back(result);
  for (const auto& [name, value] : results) std::printf("%s\t%.3f\n", name.c_str(), value);
  return 0;
}

/// The operator's tasks in the window: inputs, and the time that the keystroke-level model expects.
int print_tasks(int argc, char** argv) {
  ::setenv("QT_QPA_PLATFORM", "offscreen", 1);
  ::setenv("QT_QUICK_BACKEND", "software", 1);
  const QGuiApplication app(argc, argv);
  std::printf("\n%-50s %6s %6s %7s %6s\n", "task, by touch, 1280x720", "inputs", "wanted", "KLM, s",
              "wanted");
  int missed = 0;
  for (const adit::gui::TaskResult& task : adit::gui::do_tasks()) {
    const bool good =
        task.done && task.inputs <= task.most && (task.limit == 0.0 || task.seconds <= task.limit);
    missed += !good;
    char wanted[16] = "-";
    if (task.limit > 0.0) std::snprintf(wanted, sizeof wanted, "<= %g", task.limit);
    std::printf("%-50s %6d %6d %7.1f %6s %s\n", task.name.c_str(), task.inputs, task.most, task.seconds,
                wanted, good ? "" : "MISSED");
  }
  return missed == 0 ? 0 : 1;
}

/// Runs this program once more and reads its results.
bool add_run(const char* program, std::map<std::string, std::vector<double>>& samples) {
  const std::string line = "'" + std::string(program) + "' --once " + std::to_string(steady_ms());
  FILE* pipe = ::popen(line.c_str(), "r");
  if (pipe == nullptr) return false;
  char row[256];
  while (std::fgets(row, sizeof row, pipe) != nullptr) {
    const std::string text = row;
    const std::size_t tab = text.find('\t');
    if (tab != std::string::npos) samples[text.substr(0, tab)].push_back(std::atof(text.c_str() + tab));
  }
  return ::pclose(pipe) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The window's costs and delays without a screen and without a GPU; medians of several runs."};
  double started = 0.0;
  int repeats = 5;
  auto* once = app.add_option("--once", started, "measure once, started at this steady time, ms; for itself");
  app.add_option("--repeats", repeats, "processes (default 5)")->check(CLI::Range(1, 100));
  bool tasks = false;
  app.add_flag("--tasks", tasks, "only the operator's tasks: inputs and time by the keystroke-level model");
  app.footer("Examples:\n  ./run bench gui --repeats 3\n  ./run bench gui --tasks");
  CLI11_PARSE(app, argc, argv);
  if (tasks) return print_tasks(argc, argv);
  if (once->count() > 0) return measure_once(argc, argv, started);
  std::map<std::string, std::vector<double>> samples;
  for (int i = 0; i < repeats; ++i) {
    std::fprintf(stderr, "\rrun %d of %d", i + 1, repeats);
    if (!add_run(argv[0], samples)) {
      std::fprintf(stderr, "\nbench_gui: a run failed\n");
      return 1;
    }
  }
  std::fprintf(stderr, "\r                \r");
  std::printf("%-50s %9s %9s %s\n", "", "median", "wanted", "");
  int missed = 0;
  for (const Limit& limit : kLimits) {
    const double value = share_below(samples[limit.name], 0.5);
    const bool good = (limit.most == 0 || value <= limit.most) && (limit.least == 0 || value >= limit.least);
    missed += !good;
    char wanted[32] = "-";
    if (limit.most > 0) std::snprintf(wanted, sizeof wanted, "<= %g", limit.most);
    if (limit.least > 0) std::snprintf(wanted, sizeof wanted, ">= %g", limit.least);
    std::printf("%-50s %9.1f %9s %s\n", limit.name, value, wanted, good ? "" : "MISSED");
  }
  missed += print_tasks(argc, argv);
  return missed == 0 ? 0 : 1;
}
