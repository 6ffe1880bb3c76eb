#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# The check `language` finds what each of its rules is there for, and leaves plain text alone.
set -uo pipefail
# shellcheck source=tests/lint/tree.sh
source "$(dirname "$0")/tree.sh"

# finds TEXT LINE...: a file of these lines has this finding; clean LINE...: it has none.
file=examples/a.hpp
finds() {
  local text="$1"
  shift
  put "$file" "$(printf '%s\\n' "$@")"
  expect language "$text"
  rm "$tree/$file"
}
clean() { finds "" "$@"; }

# --- house words -------------------------------------------------------------------------------------------
for word in anew whoever nobody "nobody's" told tells "what waits" "in its turn" "in vain" seat shelf Ether tape; do
  finds "$file:2: \"" "int a;" "int b;  // The peer $word, or so."
done
finds "$file:1: \"" "/* The peer is told. */"
finds "$file:2: \"" "/* A comment" "   about a peer that is told of it. */ int a;"
clean "/// Restarts the component: \`anew\` is a name here." "int retold, tape_width;  // ethernet, foretold" \
  "const char* anew(const char* whoever = \"nobody was told // anew\");" \
  "auto raw = R\"x(" "// told anew, in vain" ")x\";" "// The old \"word\" it's 'quoted'."
file=examples/a.md
finds "$file:1: \"" "The operator is told."
clean "The operator is notified by \`tell\`." "" "\`\`\`" "told anew" "\`\`\`" "" "    told anew"
for file in examples/a.sh examples/CMakeLists.txt examples/a.yaml examples/a.awk examples/a.idl; do
  comment='#'
  [ "${file##*.}" != idl ] || comment='//'
  finds "$file:2: \"" "x" "y $comment made anew"
  clean "x=told" "y $comment Restarted."
done

# --- `///` comments begin with a capital letter ------------------------------------------------------------
file=examples/a.hpp
finds "$file:1: begins in lower case: the peer" "/// the peer"
finds "$file:1: begins in lower case" "int a;  ///< in the map frame, m"
finds "$file:1: begins in lower case" "int a;  ///< m above the ground"
finds "$file:1: begins in lower case" "int a;  ///< s: how long it lasts"
finds "$file:1: begins in lower case" "double v;  ///< m/s: slower is standing"
finds "$file:1: begins in lower case" "int a;  ///< a peer"
finds "$file:1: begins in lower case" "int a;  ///< e.g. a peer"
finds "$file:2: begins in lower case" "int a;  ///< The peer." "int b;  ///< the other"
finds "$file:2: begins in lower case" "int a;" "/// the peer"
finds "$file:3: begins in lower case" "/// The first paragraph." "///" "/// the second one"
clean "/// The peer" "/// that was heard first." "int a;  ///< Of two lines," "        ///< the second one."
clean "int a;  ///< m" "int b;  ///< m/s2" "int c;  ///< rad/s, [0, 10]" "int d;  ///< ms, (0, 10 s]" "int e;  ///< Hz" \
  "int f;  ///< 0: unset" "int g;  ///< (m, m)" "int h;  ///< kbit/s"
clean "/// \`a\` is a peer." "/// max_peers and more." "/// x, y and yaw." "/// config/links/mesh.yaml is one." \
  "/// std::nullopt: none." "/// iLQR." "/// @param a A peer." "//// rule" "// the peer" "int a;  // the peer" "///< "

# --- constants ---------------------------------------------------------------------------------------------
finds "$file:1: constant max_peers, not kLikeThis" "constexpr int max_peers = 3;"
finds "$file:2: constant max_peers, not" "namespace adit {" "inline constexpr int max_peers{3};" "}"
finds "$file:1: constant names, not" "const std::map<int, int> names{{1, 2}, {3, 4}};"
finds "$file:1: constant table, not" "constexpr Table table = make({1, 2});"
finds "$file:1: constant text, not" "const char* const text = \"x\";"
finds "$file:1: constant b, not" "constexpr int kA = f(1, 2), b = 4;"
finds "$file:1: constant digits, not" "constexpr char digits[] = \"012\";"
finds "$file:2: constant add, not" "" "constexpr auto add = [](int a) { return a; };"
finds "$file:4: constant most, not" "struct A : B<int> {" "  int a{};" " public:" "  static constexpr int most{3};" "};"
finds "$file:3: constant most, not" "enum class E { a, b };" "void f() { const int a = 3; }" "const int most = 3;"
finds "$file:4: constant most, not" "#define BRACE {" "int f(int a) {" "  if (a) { return 1; } }" "const int most = 3;"
clean "constexpr int kMaxPeers = 3, kB{4};" "class A {" " public:" "  A() : a_{1}, b_(2) {}" \
  "  static constexpr Duration kPeriod = 20ms;  ///< Of 20 s." "  const int a_{3};" "  static constexpr int most() { return 1; }" \
  "  constexpr bool operator==(const A& other) const = default;" "  static const A& shipped();" "};"
clean "constexpr int twice(int a) {" "  constexpr int two = 2;" "  static const int one{1};" "  return two * a;" "}" \
  "const char* name = \"a\";" "const char* to_string(A a);" "template <class T>" "constexpr bool is_small_v = sizeof(T) < 8;" \
  "template <>" "struct hash<A> {" "  static constexpr bool value = true;" "};" \
  "TEST(A, b) {" "  const auto f = [](int c) { return c; };" "  constexpr int d = 1;" "}"
file=examples/a.idl
clean "const long max_peers = 3;"

# --- columns -----------------------------------------------------------------------------------------------
wide="$(printf 'x%.0s' $(seq 120))"
file=examples/a.md
finds "$file:2: 121 columns" "" "${wide}y"
clean "$wide" "| $wide | in a table |" "${wide%xxxx}äöü─"
finds "$file:1: 121 columns" "${wide}ä"
file=examples/a.hpp
clean "// $wide"

# --- folders -----------------------------------------------------------------------------------------------
put nav/a.hpp '// Made anew.\n'
expect language "nav/a.hpp:1: \"anew\""
[ "$("$lint" --root "$tree" --count language | grep '^nav' | tr -s ' ')" = "nav 1 0 0 0" ] ||
  { echo "--count does not count nav"; failed=1; }
exit $failed
