# SPDX-License-Identifier: Apache-2.0
# The relevant lines of a ctest run: one every hundred tests, every test that did not pass, one that passed only when it
# was run again, ctest's own summary, and last the names of those that needed a second try, which are also appended to
# the file `second_tries`. All of it is in build/PRESET/Testing/Temporary/LastTest.log.
function shortened(line) {
  sub(/ *# (GetParam|TypeParam).* \.\.\./, " ...", line)
  gsub(/ ?\.\.\.+ ?/, " .. ", line)
  return substr(line, 1, 300)
}
function name_of(line) {
  sub(/^.*Test +#[0-9]+: /, "", line)
  sub(/ \.\.\..*$/, "", line)
  return line
}
/^ +Start +[0-9]+: / { next }
/ Test +#[0-9]+: / {
  name = name_of($0)
  if ($0 !~ / Passed +[0-9.]+ sec/) failed[name] = 1
  else if (name in failed) {
    second_try = second_try (second_try == "" ? "" : ", ") name
    if (second_tries != "") print name >> second_tries
  }
  else if (++passed % 100 != 0) next
  print shortened($0)
  fflush()
  next
}
NF > 0 { print substr($0, 1, 300); fflush() }
END { if (second_try != "") print "passed only at the second try: " second_try }
