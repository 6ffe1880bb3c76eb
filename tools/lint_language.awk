# SPDX-License-Identifier: Apache-2.0
# The language of comments, docs and constants, for `tools/lint.sh language`. Reads source files and prints
# "RULE FILE:LINE: what" for each finding; RULE is words, comments, constants or columns.
# Run with LC_ALL=C: columns are counted in UTF-8 by hand, as mawk knows bytes only.

BEGIN {
  # House words, as a regular expression, and what the field says instead.
  house("anew|made new", "again, restarted, rebuilt")
  house("whoever|whomever", "the station, peer or operator that ...")
  house("nobody", "no station, no peer, unset")
  house("told|tells?", "notified, reports")
  house("what waits", "name what is queued")
  house("what (it|he|she) has", "name the thing")
  house("at least one who", "name the party")
  house("in (its|his|her|their) turn", "then, in order")
  house("in vain", "without success")
  house("seats?", "slot")
  house("shelf|shelves", "finding store")
  house("ether", "simulated network")
  house("tape", "record sink")

  unit = "(%|m|s|ms|us|ns|h|min|rad|deg|degrees|g|kg|hz|khz|db|dbm|v|a|w|wh|n|nm|l|px|pixels|rows|columns|cells|" \
         "bits?|kbit|mbit|bytes?|kb|mb|kib|mib|b)[23]?"
  units = "^" unit "([*/ ]" unit ")*(, [[(].*[])])?[.]?$"
}

function house(pattern, plain) {
  ++houses
  house_word[houses] = "[^a-z_](" pattern ")[^a-z_]"
  house_plain[houses] = plain
}

function found(rule, text) { printf "%s %s:%d: %s\n", rule, FILENAME, FNR, text }

# Prose without what stands in backticks, padded so that every word has a neighbour on both sides.
function check_words(text,   i, word) {
  gsub(/`[^`]*`/, "`", text)
  text = " " tolower(text) " "
  gsub(/'s?[^a-z]/, " ", text)
  for (i = 1; i <= houses; ++i)
    if (match(text, house_word[i])) {
      word = substr(text, RSTART + 1, RLENGTH - 2)
      found("words", "\"" word "\" is a word of our own; plain: " house_plain[i])
    }
}

# --- `///` comments: the first word begins with a capital letter -------------------------------------------

# A unit alone may stand in lower case, and so may code: `x`, axis names, names with _ :: ( . / or an inner capital.
function begins_in_lower_case(text,   word) {
  sub(/^ +/, "", text)
  if (text !~ /^[a-z]/) return 0
  word = text
  sub(/ .*/, "", word)
  if (tolower(text) ~ units) return 0
  sub(/[,:;]$/, "", word)
  if (tolower(word) ~ units) return 1
  return word !~ /^[b-z]$|[_(A-Z0-9]|::|[.\/][a-z][a-z]/
}

# start: nothing of this comment stands on the line before.
function check_comment(text, start) {
  if (start && begins_in_lower_case(text)) {
    sub(/^ +/, "", text)
    found("comments", "begins in lower case: " substr(text, 1, 50))
  }
}

# --- constants: kLikeThis at the scope of namespaces and classes -------------------------------------------

# Takes what stands between < and > away.
function without_templates(text) {
  gsub(/operator *[^ (a-zA-Z_]+/, "operator_", text)
  gsub(/<=>|<<|>=|<=|->/, " ", text)
  while (gsub(/<[^<>]*>/, " ", text)) {}
  return text
}

function scope_of_brace(text,   plain) {
  plain = without_templates(text)
  if (plain ~ /(^|[^a-zA-Z_0-9])enum[^a-zA-Z_0-9]/) return "other"
  if (plain ~ /=/) return "other"
  if (plain ~ /(^|[^a-zA-Z_0-9])namespace([^a-zA-Z_0-9]|$)/ || plain ~ /^ *extern *"" *$/) return "namespace"
  gsub(/alignas *\([^)]*\)/, "", plain)
  if (plain ~ /\(/) return "other"
  if (plain ~ /(^|[^a-zA-Z_0-9])(class|struct|union)([^a-zA-Z_0-9]|$)/) return "class"
  return "other"
}

# Whether it defines a function, whose body ends it without a semicolon.
function is_function(text,   plain) {
  plain = without_templates(text)
  sub(/[={].*/, "", plain)
  return plain ~ /\(/
}

function check_constant(text, line,   plain, declarators, parts, n, i, name) {
  if (text !~ /const/) return
  plain = without_templates(text)
  gsub(/(public|private|protected) *:/, " ", plain)
  gsub(/\[\[[^]]*\]\]/, " ", plain)
  gsub(/\[[^]]*\]/, "", plain)
  sub(/^ +/, "", plain)
  if (plain ~ /^(template|using|typedef|friend|static_assert)/ || plain ~ /^extern +template/) return
  declarators = plain
  sub(/[={].*/, "", declarators)
  if (declarators ~ /\(/) return
  if (declarators !~ /(^| )constexpr /) {
    if (declarators ~ /&/ || declarators !~ /(^| )const( |$)/) return
    if (declarators ~ /[*]/ && declarators !~ /[*] *const /) return
    if (scope[depth] == "class" && declarators !~ /(^| )static /) return
  }
  # The values go, what is left are the names: the first with its type, more after commas.
  while (gsub(/\([^()]*\)/, "", plain)) {}
  gsub(/\{\}/, "", plain)
  n = split(plain, parts, ",")
  for (i = 1; i <= n; ++i) {
    name = parts[i]
    if (i > 1 && name !~ /^ *[a-zA-Z_][a-zA-Z_0-9]* *(=|$)/) continue
    sub(/=.*/, "", name)
    sub(/ +$/, "", name)
    sub(/.*[^a-zA-Z_0-9]/, "", name)
    if (name !~ /^k[A-Z0-9]/ && name != "value")
      printf "constants %s:%d: constant %s, not kLikeThis\n", FILENAME, line, name
  }
}

# Follows braces; code holds neither comments nor the contents of strings.
function follow(code,   at, sign) {
  while (match(code, /[{}();]/)) {
    at = RSTART
    sign = substr(code, at, 1)
    take(substr(code, 1, at - 1))
    code = substr(code, at + 1)
    if (sign == "{") {
      brace_parens[depth] = parens
      brace_text[depth] = statement
      scope[depth + 1] = scope[depth] == "other" || parens > 0 ? "other" : scope_of_brace(statement)
      if (scope[depth + 1] != "other") statement = ""
      ++depth
      parens = 0
    } else if (sign == "}") {
      if (depth == 0) continue  # the branches of an #if
      --depth
      parens = brace_parens[depth]
      statement = brace_text[depth]
      if (scope[depth] == "other") continue
      if (scope[depth + 1] != "other" || (parens == 0 && is_function(statement))) statement = ""
      else statement = statement "{}"
    } else if (scope[depth] == "other") {
      continue
    } else if (sign == "(") {
      statement = statement "("
      ++parens
    } else if (sign == ")") {
      statement = statement ")"
      if (parens > 0) --parens
    } else if (parens == 0) {
      check_constant(statement, statement_line)
      statement = ""
    }
  }
  take(code " ")
}

function take(text) {
  if (scope[depth] == "other") return
  if (statement ~ /^ *((public|private|protected) *: *)?$/) statement_line = FNR
  statement = statement text
}

# --- files -------------------------------------------------------------------------------------------------

# Takes one line of C++ or IDL apart, into code (strings are empty) and comment.
function split_line(line,   rest, at, sign, end) {
  code = comment = ""
  rest = line
  if (in_block) {
    if (!(at = index(rest, "*/"))) { comment = rest; return }
    comment = substr(rest, 1, at - 1)
    rest = substr(rest, at + 2)
    in_block = 0
  }
  if (raw_end != "") {
    if (!(at = index(rest, raw_end))) return
    rest = substr(rest, at + length(raw_end))
    raw_end = ""
  }
  while (match(rest, /["']|\/\/|\/[*]/)) {
    at = RSTART
    sign = substr(rest, at, RLENGTH)
    if (sign == "//") {
      code = code substr(rest, 1, at - 1)
      comment = comment substr(rest, at)
      return
    }
    code = code substr(rest, 1, at - 1)
    rest = substr(rest, at)
    if (sign == "/*") {
      if (!(end = index(rest, "*/"))) { comment = comment substr(rest, 3); in_block = 1; return }
      comment = comment substr(rest, 3, end - 3)
      rest = substr(rest, end + 2)
    } else if (sign == "\"" && code ~ /(^|[^a-zA-Z_0-9])(u8)?R$/) {
      end = index(rest, "(")
      raw_end = ")" substr(rest, 2, end - 2) "\""
      code = code "\"\""
      if (!(at = index(rest, raw_end))) return
      rest = substr(rest, at + length(raw_end))
      raw_end = ""
    } else if (sign == "'" && code ~ /[0-9a-fA-F]$/) {
      rest = substr(rest, 2)  # 1'000
    } else if (match(rest, sign == "\"" ? "^\"(\\\\.|[^\"\\\\])*\"" : "^'(\\\\.|[^'\\\\])*'")) {
      code = code "\"\""
      rest = substr(rest, RLENGTH + 1)
    } else {
      rest = substr(rest, 2)
    }
  }
  code = code rest
}

FNR == 1 {
  kind = FILENAME ~ /\.(hpp|cpp)$/ ? "cpp" : FILENAME ~ /\.idl$/ ? "idl" : FILENAME ~ /\.md$/ ? "md" : "hash"
  in_block = fenced = depth = parens = directive = 0
  raw_end = statement = before = ""
  scope[0] = "namespace"
}

kind == "md" {
  text = $0
  gsub(/[\200-\277]/, "", text)
  if (length(text) > 120 && text !~ /^ *[|]/) found("columns", length(text) " columns, at most 120")
  if ($0 ~ /^ *```/) fenced = !fenced
  else if (!fenced && $0 !~ /^    /) check_words($0)
  next
}

kind == "hash" {
  if (match($0, /(^|[ \t])#[^!]/)) check_words(substr($0, RSTART + 1))
  next
}

{
  split_line($0)
  if (comment != "") check_words(comment)
  if (comment ~ /^\/\/\/([^\/]|$)/) {
    text = comment
    sub(/^\/\/\/<? */, "", text)
    # A comment goes on where a line holds nothing else and the line before is a comment, too, that is not empty.
    check_comment(text, code !~ /^ *$/ || before == "")
    before = text
  } else {
    before = ""
  }
  if (kind != "cpp") next
  if (directive || code ~ /^ *#/) { directive = code ~ /\\$/; next }
  follow(code)
}
