# SPDX-License-Identifier: Apache-2.0
# Out of ctest's LastTest.log: each test that failed, and the last lines that it printed (at most `lines` of each, `most`
# in all).
/^[0-9]+\/[0-9]+ Testing: / { name = $0; sub(/^.*Testing: /, "", name); count = 0; reading = 0 }
/^Output:$/ { reading = 1; next }
/^<end of output>$/ { reading = 0; next }
reading && !/^-+$/ { kept[count++ % lines] = substr($0, 1, 300) }
/^Test Failed\.$|^Test (Timeout|timeout)|^Test Passed\.$/ {
  if ($0 ~ /Passed/ || printed >= most) next
  print "-- " substr(name, 1, 200) ": " $0
  for (i = count > lines ? count - lines : 0; i < count; i++) { print "   " kept[i % lines]; printed++ }
}
