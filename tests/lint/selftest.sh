#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# Every check of tools/lint.sh finds what it is there for, and leaves a clean tree alone.
set -uo pipefail
# shellcheck source=tests/lint/tree.sh
source "$(dirname "$0")/tree.sh"

put core/a.hpp '#include "core/b.hpp"\n#include <vector>\n'
put nav/a.hpp '#include "core/geometry/pose.hpp"\n#include "nav/b.hpp"\n'
put core/wire/w.cpp '#include <fastdds/dds/x.hpp>\n#include "adit/command.h"\n'
put tests/t.cpp '#include "robot_agent/a.hpp"\n#include <fastdds/dds/x.hpp>\n'
for check in includes circles sizes words sleeps; do expect $check ""; done

put core/up.hpp '\n#include "robot_agent/agent.hpp"\n'
expect includes 'core/up.hpp:2: core may not include robot_agent/agent.hpp'
put nav/exec.cpp '#include "core/exec/executor.hpp"\n'
expect includes 'nav/exec.cpp:1: nav may not include core/exec/executor.hpp'
put basestation/n.cpp '  #  include "nav/planner.hpp"\n'
expect includes 'basestation/n.cpp:1: basestation may not include nav/planner.hpp'
put robot_agent/f.cpp '#include <fastdds/dds/x.hpp>\n'
expect includes 'robot_agent/f.cpp:1: Fast DDS headers'
put nav/m.cpp '#include "geometry_msgs/msg/Twist.h"\n'
expect includes 'nav/m.cpp:1: generated types'
put basestation/gui/a.cpp '#include "basestation/fleet/fleet.hpp"\n#include <QString>\n'
expect includes 'basestation/gui/a.cpp:1: basestation may not include basestation/fleet/fleet.hpp'
put nav/q.cpp '#include <QString>\n'
expect includes 'nav/q.cpp:1: Qt belongs into basestation/gui'
put core/rel.cpp '#include "../x.hpp"\n'
expect includes 'core/rel.cpp:1: includes are written from the root'

put core/b/b.hpp '#include "core/c/c.hpp"\n#include "core/top.hpp"\n'
put core/top.hpp '#include "core/d/d.hpp"\n'
put core/all.cpp '#include "core/b/b.hpp"\n#include "core/all.hpp"\n'
put sim/b/b.hpp '#include "sim/c/c.hpp"\n'
put core/c/c.hpp '#include "sim/b/b.hpp"\n'
expect circles ""
put core/d/d.cpp '\n#include "core/b/b.hpp"\n'
expect circles 'core/d/d.cpp:2: a circle: core/d includes core/b, whose includes lead back to core/d'
expect circles 'core/top.hpp:1: a circle: core/top.hpp includes core/d, whose includes lead back to core/top.hpp'

put nav/CMakeLists.txt '# USES a folder\nfunction(nav_library folder)\nnav_library(e SOURCES e.cpp)\nnav_library(f USES e\n  g SOURCES f.cpp)\n'
put nav/e/e.cpp '#include "core/b/b.hpp"\n#include "nav/e/e.hpp"\n'
put nav/f/f.cpp '#include "nav/e/e.hpp"\n#include "nav/g/h/g.hpp"\n'
expect links ""
put nav/e/e.hpp '\n#include "nav/g/h/g.hpp"\n'
expect links 'nav/e/e.hpp:2: nav/CMakeLists.txt does not name g among what e USES'
put nav/f/f.cpp '#include "nav/e/e.hpp"\n'
expect links 'nav/CMakeLists.txt:5: f USES g, but includes none of it'

put sim/long.cpp "$(printf 'x\\n%.0s' $(seq 601))"
expect sizes 'sim/long.cpp: 601 lines'
put core/word.cpp '// TO''DO later\n'
expect words 'core/word.cpp:1'
put tests/s.cpp 'std::this_thread::sleep''_for(1s);\n'
expect sleeps 'tests/s.cpp:1'
put tests/a.cpp 'const auto folder = scratch_folder();\nopen({.domain = live::domain()});\nopen({.domain = 233});\n'
put tests/a.sh 'x="$(mktemp -d)"\n'
put sim/a.cpp 'std::filesystem::temp_directory_path();\n'
expect sharing ""
shared=0
for line in 'std::filesystem::temp_directory_path()' 'testing::TempDir()' '::mkdtemp(name)' 'open("/tmp/x")' 'htons(7400)' \
    'open({.domain = 77})' 'run({"basestation", "--domain", "7"})'; do
  put "tests/shared$((++shared)).cpp" "\\n$line\\n"
  expect sharing "tests/shared$shared.cpp:2:"
done
put tests/l/CMakeLists.txt 'adit_test(l SOURCES\n  one_test.cpp\n  m/two_test.cpp)\n'
put tests/l/one_test.cpp '\n'
put tests/l/m/two_test.cpp '\n'
expect listed ""
put tests/l/three_test.cpp '\n'
expect listed 'tests/l/three_test.cpp: no CMakeLists.txt names it'
put basestation/gui/qml/A.qml '// SPDX-License-Identifier: Apache-2.0\nItem {\n  function onB(c) { d.e(c) }\n}\n'
expect qml ""
put basestation/gui/qml/A.qml "$(printf 'x\\n%.0s' $(seq 201))"
expect qml 'basestation/gui/qml/A.qml: no line SPDX'
expect qml 'basestation/gui/qml/A.qml: more than 200 lines'
put basestation/gui/qml/A.qml '// SPDX-License-Identifier: Apache-2.0\n  function a() {\n  onB: {\n'
expect qml 'basestation/gui/qml/A.qml:2: a function'
expect qml 'basestation/gui/qml/A.qml:3: more than a binding'
put CMakeLists.txt 'project(adit VERSION 0.2.0 LANGUAGES CXX)\n'
put CITATION.cff 'cff-version: 1.2.0\nversion: 0.2.0\n'
expect citation ""
put CITATION.cff 'cff-version: 1.2.0\nversion: 0.1.0\n'
expect citation "CITATION.cff: version '0.1.0'"

rm -r "$tree"; mkdir "$tree"
put core/a.cpp '// SPDX-License-Identifier: Apache-2.0\n#pragma once\n'
put CMakeLists.txt '# SPDX-License-Identifier: Apache-2.0\n'
put tools/a.sh '#!/bin/bash\n# SPDX-License-Identifier: Apache-2.0\n'
expect spdx ""
put core/b.hpp '#pragma once\n// SPDX-License-Identifier: Apache-2.0\n'
expect spdx 'core/b.hpp: no line SPDX'
put core/empty.cpp 'int a;\n// The last file.\n'
expect spdx 'core/empty.cpp: no line SPDX'

put core/format.cpp 'int   x ;\n'
put .clang-format 'BasedOnStyle: Google\n'
expect format 'core/format.cpp: '
# A run of ctest in short: what failed, and last the names of those that passed only when they were run again.
summary() { printf '%s\n' "$@" | awk -f "$(dirname "$lint")/ctest_summary.awk" | tail -n 1; }
again=(
  '1/3 Test #1: a.Good ............   Passed    0.01 sec'
  '2/3 Test #2: a.Late ............***Failed    0.01 sec'
  '3/3 Test #3: a.Slow ............***Timeout  60.00 sec'
  '    Test #2: a.Late ............   Passed    0.00 sec'
  '    Test #3: a.Slow ............   Passed    0.00 sec' '' '100% tests passed, 0 tests failed out of 3')
last="$(summary "${again[@]}")"
if [ "$last" != 'passed only at the second try: a.Late, a.Slow' ]; then echo "ctest_summary: $last"; failed=1; fi
last="$(summary "${again[0]}" '' '100% tests passed, 0 tests failed out of 1')"
if [ "$last" != '100% tests passed, 0 tests failed out of 1' ]; then echo "ctest_summary: $last"; failed=1; fi
exit $failed
