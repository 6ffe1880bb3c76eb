#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The rules of the source tree, checked. usage: tools/lint.sh [--root DIR] [CHECK...]
#                                               tools/lint.sh [--root DIR] --count language
# Each finding is one line "file[:line]: what"; exit status 1 when there is one.
set -uo pipefail
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
language_rules="$root/tools/lint_language.awk"
if [ "${1:-}" = --root ]; then root="$2"; shift 2; fi
cd "$root" || exit 2

# Sources that are there, whether git knows them or not: the tree may be an unpacked archive.
files() {
  find . -path ./build -prune -o -path ./data -prune -o -path ./.git -prune -o -type f \( "$@" \) -print |
    sed 's|^\./||' | sort
}
cpp() { files -name '*.hpp' -o -name '*.cpp'; }

# --- includes: the table of docs/architecture.md ---------------------------------------------------
check_includes() {
  cpp | xargs -r awk '
    BEGIN {
      split("idl core nav perception robot_agent basestation sim", order, " ")
      may["core"] = "core"
      may["nav"] = "nav"; may["perception"] = "perception"
      may["robot_agent"] = "core nav perception robot_agent"
      may["basestation"] = "core perception basestation"
      may["sim"] = "core nav perception robot_agent basestation sim"
      for (i in order) part[order[i]] = 1
      front_end["model"] = "model"; front_end["input"] = "model|input"; front_end["client"] = "model|client"; front_end["alert"] = "model|alert"
      front_end["gui"] = "model|client|alert|input|gui"
      part["tests"] = part["bench"] = part["examples"] = 1
    }
    function allowed(from, to, whole,   list, n, i) {
      if (from == "tests" || from == "bench" || from == "examples") return 1
      if ((from == "nav" || from == "perception") && to == "core")
        return whole ~ /^core\/((time|geometry|result|config)\/|store\/(pack|crc32c)\.hpp$)/
      # Front ends receive values; the station behind the socket is not theirs.
      if (from == "basestation" && to == "basestation" && path[2] in front_end)
        return whole ~ "^basestation/(" front_end[path[2]] ")/"
      if (from == "basestation" && path[2] == "gui") return to == "core" || whole ~ /^perception\/camera\//
      if (from == "basestation" && to == "perception") return whole ~ /^perception\/(camera|map|stream|types)\//
      n = split(may[from], list, " ")
      for (i = 1; i <= n; i++) if (list[i] == to) return 1
      return 0
    }
    /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
      split(FILENAME, path, "/"); from = path[1]
      if (!(from in part)) next
      file = $0; sub(/^[^<"]*[<"]/, "", file); sub(/[>"].*/, "", file)
      split(file, parts, "/"); to = parts[1]
      in_wire = FILENAME ~ /^core\/wire\//; in_contract = FILENAME ~ /^core\/contract\//
      if (to in part && !allowed(from, to, file))
        printf "%s:%d: %s may not include %s\n", FILENAME, FNR, from, file
      if (file ~ /^Q[A-Z]|^Qt[A-Z].*\// && FILENAME !~ /^(basestation|bench|tests)\/gui\//)
        printf "%s:%d: Qt belongs into basestation/gui\n", FILENAME, FNR
      if (file ~ /^\.\.?\//) printf "%s:%d: includes are written from the root\n", FILENAME, FNR
      if ((to == "fastdds" || to == "fastrtps" || to == "fastcdr") && !in_wire && from != "tests")
        printf "%s:%d: Fast DDS headers belong into core/wire/\n", FILENAME, FNR
      if ((to == "adit" || file ~ /^(builtin_interfaces|std_msgs|geometry_msgs|nav_msgs|sensor_msgs|tf2_msgs)\//) && !in_wire && !in_contract &&
          from !~ /^(robot_agent|basestation|sim|tests|bench|examples)$/)
        printf "%s:%d: generated types belong into core/contract, core/wire, robot_agent, basestation and sim\n", FILENAME, FNR
    }'
}

# --- circles: within a part, no folder includes another one that includes it, directly or through others ------
# A file directly in the part's folder counts as a folder of its own: such a header may be used by everybody, or
# compose everything, but not both.
check_circles() {
  cpp | xargs -r awk '
    /^[ \t]*#[ \t]*include[ \t]*"/ {
      file = $0; sub(/^[^"]*"/, "", file); sub(/".*/, "", file)
      split(FILENAME, path, "/"); split(file, parts, "/")
      if (path[1] == "tests" || path[1] == "bench" || path[1] != parts[1] || path[2] == parts[2]) next
      from = path[1] "/" path[2]; to = parts[1] "/" parts[2]
      node[from] = node[to] = 1
      reach[from, to] = 1
      line[++lines] = FILENAME ":" FNR; of[lines] = from; into[lines] = to
    }
    END {
      for (via in node) for (from in node) if ((from, via) in reach)
        for (to in node) if ((via, to) in reach) reach[from, to] = 1
      for (i = 1; i <= lines; ++i)
        if ((into[i], of[i]) in reach)
          printf "%s: a circle: %s includes %s, whose includes lead back to %s\n", line[i], of[i], into[i], of[i]
    }'
}

# --- links: what nav_library() of nav/CMakeLists.txt declares as USES is what the folder includes ----------------
check_links() {
  [ -f nav/CMakeLists.txt ] || return 0
  { echo nav/CMakeLists.txt; cpp | grep '^nav/[^/]*/'; } | xargs -r awk '
    FILENAME ~ /CMakeLists.txt$/ {
      sub(/#.*/, ""); if (/^[a-z_]+\(/) from = ""
      count = split($0, word, /[ ()]+/)
      for (i = 1; i <= count; ++i) {
        if (word[i] == "nav_library") { from = word[++i]; uses = 0 }
        else if (word[i] ~ /^(USES|SOURCES)$/) uses = word[i] == "USES"
        else if (uses && from != "" && word[i] != "") line[from, word[i]] = FNR
      }
      next
    }
    /^[ \t]*#[ \t]*include[ \t]*"nav\/[^\/"]*\// {
      split(FILENAME, path, "/"); split($0, parts, "/")
      if (path[2] == parts[2]) next
      used[path[2], parts[2]] = 1
      if (!((path[2], parts[2]) in line))
        printf "%s:%d: nav/CMakeLists.txt does not name %s among what %s USES\n", FILENAME, FNR, parts[2], path[2]
    }
    END {
      for (pair in line) if (!(pair in used)) {
        split(pair, names, SUBSEP)
        printf "nav/CMakeLists.txt:%d: %s USES %s, but includes none of it\n", line[pair], names[1], names[2]
      }
    }'
}

# --- sizes: median at most 120 lines, nine of ten at most 400, none above 600 -------------------------
check_sizes() {
  cpp | xargs -r wc -l | awk '$2 != "total" { print $1, $2 }' | sort -n | awk '
    { lines[NR] = $1; if ($1 > 600) printf "%s: %d lines, at most 600\n", $2, $1 }
    END {
      if (NR == 0) exit
      if (lines[int((NR + 1) / 2)] > 120) printf "(all): the median file has %d lines, at most 120\n", lines[int((NR + 1) / 2)]
      if (lines[int((NR * 9 + 9) / 10)] > 400) printf "(all): the 90th percentile is %d lines, at most 400\n", lines[int((NR * 9 + 9) / 10)]
    }'
}

# --- words that announce unfinished work ------------------------------------------------------------
check_words() {
  files -name '*.hpp' -o -name '*.cpp' -o -name '*.md' -o -name '*.cmake' -o -name 'CMakeLists.txt' -o -name '*.sh' \
      -o -name '*.idl' -o -name '*.yaml' -o -name '*.xml' -o -name run |
    grep -v '^tools/lint.sh$\|^tests/lint/' |
    xargs -r grep -nwiE 'TODO|FIXME|XXX|HACK|for now|stubs?|placeholders?' /dev/null | sed 's/$/   <- unfinished/'
}

# --- language: plain words in comments and docs, one style of constants ---------------------------------
# tools/lint_language.awk has the rules: words (house words), comments (`///` begins with a capital letter), constants
# (kLikeThis at the scope of namespaces and classes), columns (at most 120 in docs, table rows apart).

# Every finding, in any folder: "RULE FILE:LINE: what"
language_findings() {
  files -name '*.hpp' -o -name '*.cpp' -o -name '*.idl' -o -name '*.md' -o -name '*.cmake' -o -name 'CMakeLists.txt' \
      -o -name '*.sh' -o -name '*.awk' -o -name '*.yaml' -o -name '*.yml' -o -name run |
    grep -v '^tests/lint/' | LC_ALL=C xargs -r awk -f "$language_rules"
}

check_language() { language_findings | sed 's/^\([^ ]*\) \(.*\)/\2   <- \1/'; }

# How many findings each folder has.
count_language() {
  language_findings | awk '
    { folder = $2; if (!sub(/\/.*/, "", folder)) folder = "."; ++count[folder, $1]; folders[folder] = 1 }
    END {
      n = split("words comments constants columns", rules, " ")
      printf "%-12s", "folder"; for (i = 1; i <= n; ++i) printf " %9s", rules[i]; print ""
      for (folder in folders) {
        printf "%-12s", folder | "sort"
        for (i = 1; i <= n; ++i) printf " %9d", count[folder, rules[i]] | "sort"
        print "" | "sort"
      }
    }'
}

# --- tests wait for something, never for time; components never sleep --------------------------------
check_sleeps() {
  cpp | grep -E '^(tests|core|nav|perception|robot_agent|basestation|sim)/' |
    xargs -r grep -nE '\b(sleep_for|sleep_until|usleep|nanosleep)\b|[^_a-zA-Z]sleep\(' /dev/null |
    sed 's/$/   <- sleeps/'
}

# --- sharing: no two tests share a folder, a port or a domain ---------------------------------------------
# Files are below scratch_folder(), domains are those of live::domain(), ports are the kernel's choice. The locks of
# live::Domains (process.cpp) are the machine's, and domains above 232 are none.
check_sharing() {
  files -name '*.hpp' -o -name '*.cpp' -o -name '*.sh' | grep '^tests/' | grep -v '^tests/lint/\|^tests/folders/\|^tests/live/isolated.sh' |
    xargs -r grep -nE 'temp_directory_path|TempDir\(|mk[ds]temp\(|tmpnam|/tmp\b|htons\([1-9]|domain = [0-9]|"--(robot-)?domain", "[0-9]+"' /dev/null |
    grep -vE '^tests/live/process.cpp:.*temp_directory_path|domain(",)? [="]+ ?(23[3-9]|[3-9][0-9]{2})\b' | sed 's/$/   <- shared with other tests/'
}

# --- listed: a test that no CMakeLists.txt names is never built ------------------------------------------------
check_listed() {
  { files -name CMakeLists.txt | grep '^tests/' | xargs -r awk '
      { folder = FILENAME; sub(/[^\/]*$/, "", folder); gsub(/[()"]/, " ") }
      { for (i = 1; i <= NF; ++i) if ($i ~ /_test\.cpp$/) { sub(/^\$\{PROJECT_SOURCE_DIR\}\//, "/", $i)
                                                          print "named", $i ~ /^\// ? substr($i, 2) : folder $i } }'
    files -name '*_test.cpp' | grep '^tests/' | sed 's/^/there /'; } |
    awk '$1 == "named" { named[$2] = 1 }
         $1 == "there" && !named[$2] { print $2 ": no CMakeLists.txt names it, so it is not built" }'
}

# --- citation: the version in CITATION.cff is the project's ------------------------------------------------
check_citation() {
  local cited project
  cited="$(sed -n 's/^version: *//p' CITATION.cff 2> /dev/null)"
  project="$(sed -n 's/^project(adit VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt 2> /dev/null)"
  [ "$cited" = "$project" ] || echo "CITATION.cff: version '$cited', but CMakeLists.txt has '$project'"
}

# --- spdx: sources name their licence on the first line, below #! where there is one ------------------------
check_spdx() {
  files -name '*.hpp' -o -name '*.cpp' -o -name '*.idl' -o -name '*.cmake' -o -name 'CMakeLists.txt' -o -name '*.sh' \
      -o -name '*.awk' |
    LC_ALL=C xargs -r awk '
      function judge() { if (file != "" && !licensed) print file ": no line SPDX-License-Identifier: Apache-2.0" }
      FNR == 1 { judge(); file = FILENAME; licensed = 0; first = 1 }
      FNR == 1 && /^#!/ { first = 2 }
      FNR == first && /^(\/\/|#) SPDX-License-Identifier: Apache-2\.0$/ { licensed = 1 }
      END { judge() }'
}

# --- formatting ----------------------------------------------------------------------------------------
check_format() {
  command -v clang-format > /dev/null || { echo "(format): clang-format is not installed"; return; }
  cpp | xargs -r -P "$(nproc)" -n 1 sh -c \
    'clang-format --dry-run -Werror "$1" > /dev/null 2>&1 || echo "$1: not as clang-format writes it (./run format)"' lint | sort
}

# --- qml: the window's files: what qmllint says, at most 200 lines, no functions ------------------------------
# qmllint knows the window's own types from a build; without Qt 6 or a build, only the rest is checked.
qmllint_of_qt6() {
  local tool
  for tool in /usr/lib/qt6/bin/qmllint qmllint6 qmllint; do
    # Version 5 has the name, too, and other options.
    if [[ "$("$tool" --help 2> /dev/null)" == *--unqualified* ]]; then echo "$tool"; return; fi
  done
}
check_qml() {
  local sources tool types
  sources="$(files -name '*.qml')"
  [ -n "$sources" ] || return
  # shellcheck disable=SC2086
  LC_ALL=C awk '
    FNR == 1 && !/^\/\/ SPDX-License-Identifier: Apache-2\.0$/ { print FILENAME ": no line SPDX-License-Identifier: Apache-2.0" }
    FNR == 201 { print FILENAME ": more than 200 lines" }
    # Connections has its handlers as functions, of one line.
    /^[ \t]*function[ \t]/ && !/^[ \t]*function on[A-Z][A-Za-z_]*\([a-z, ]*\) \{.*\}$/ { print FILENAME ":" FNR ": a function: rules belong into C++" }
    /(=>|on[A-Z][A-Za-z]*:)[ \t]*\{[ \t]*$/ { print FILENAME ":" FNR ": more than a binding of one line" }' $sources
  tool="$(qmllint_of_qt6)"
  types="$(ls -t build/*/basestation/gui/Adit/*.qmltypes 2> /dev/null | head -n 1)"
  if [ -z "$tool" ]; then
    echo "lint: qml: no qmllint of Qt 6 (qt6-declarative-dev-tools): it is skipped" >&2
  elif [ -z "$types" ]; then
    echo "lint: qml: adit_gui is not built: qmllint is skipped" >&2
  else
    # Delegates use the ids around them, which qmllint of Qt 6.4 always calls unqualified.
    # shellcheck disable=SC2086
    "$tool" --unqualified disable -I "$(dirname "$(dirname "$types")")" $sources 2>&1 |
      sed -nE 's/^(Warning|Error|Critical): //p'
  fi
}

check_shell() {
  command -v shellcheck > /dev/null || return 0
  { files -name '*.sh'; ls run .ci/run tools/pre-commit 2> /dev/null; } | xargs -r shellcheck -x -S warning -f gcc
}

if [ "${1:-}" = --count ]; then
  declare -F "count_${2:-}" > /dev/null || { echo "lint: nothing to count for '${2:-}'" >&2; exit 2; }
  "count_$2"
  exit
fi
checks=("$@")
[ ${#checks[@]} -gt 0 ] || checks=(includes circles links sizes words language citation spdx sleeps sharing listed qml format shell)
status=0
for check in "${checks[@]}"; do
  declare -F "check_$check" > /dev/null || { echo "lint: no check '$check'" >&2; exit 2; }
  found="$("check_$check")"
  if [ -n "$found" ]; then
    echo "$found"
    status=1
  fi
  [ -z "$found" ] && echo "lint: $check ok" || echo "lint: $check FAILED"
done
exit $status
