# What can get worse in rows of bench/rows: for each file the lines `ROW, FIELD, KIND, VALUE`, separated by tabs.
# KIND is ate (m), recall (share) or false (a count). Names of fields are the same before and after a change of wording:
# older words are read, too.
function put(field, kind, value,   key) {
  key = row ":" field
  if (++times[key] > 1) field = field " #" times[key]
  printf "%s\t%s\t%s\t%s\n", row, field, kind, value
}

function first_number(text) { match(text, /[0-9.]+/); return substr(text, RSTART, RLENGTH) + 0 }

# A / B of `A of B ...`.
function share(text,   parts) {
  split(text, parts, / of /)
  return parts[2] + 0 ? sprintf("%.4f", parts[1] / (parts[2] + 0)) : ""
}

# The second of `A / B / C`.
function second(text,   parts) { split(text, parts, / \/ /); return parts[2] + 0 }

function figure(name, value) {
  sub(/, scale aligned$/, "", name)
  if (name ~ /^ATE RMSE \(/) put("ATE m", "ate", first_number(value))
  else if (name ~ /^ATE RMSE before/) put("ATE m before loop closing", "ate", first_number(value))
  else if (name ~ /^recall at 100 % precision/) put("recall at 100 % precision", "recall", first_number(value))
  else if (name ~ /^frames with a .*pose/) put("frames with a pose", "recall", share(value))
  else if (name ~ /^(loops )?accepted: (right|true|correct) \/ (wrong|false) \//) put("false loops", "false", second(value))
  else if (name ~ /^(relocalizations|lost and found again): /) put("wrong relocalizations", "false", second(value))
  else if (name ~ /^(of these|false loops) between two floors/) put("loops between two floors", "false", first_number(value))
  else if (name ~ /^revisits closed,? or/ && share(value) != "") put("revisits closed or relocalized", "recall", share(value))
  else if (name == "revisits closed" && share(value) != "") put(name, "recall", share(value))
}

# today(WORDS): of a header or a cell, in the words of today.
function today(words) {
  sub(/^lies believed$/, "false loops accepted", words)
  sub(/the lies$/, "false loops", words)
  sub(/believed$/, "accepted", words)
  sub(/never lied to$/, "without it", words)
  sub(/^starts$/, "trials", words)
  sub(/^(right|confirmed correct)$/, "correct", words)
  sub(/^confirmed wrong$/, "wrong", words)
  sub(/^back in the map$/, "the place", words)
  sub(/^in a look-alike of half the map$/, "only its look-alike", words)
  return words
}

# kind_of(NAME): of a column of a table, or nothing.
function kind_of(name) {
  if (name ~ /accepted$/ && name ~ /^ATE/) return ""  # while the map has a false loop closure
  if (name ~ /^ATE m/) return "ate"
  if (name == "R@100P") return "recall"
  if (name ~ /^(wrong|false) of all answers$/ || name ~ /^false (loops )?accepted$/) return "false"
  if (has_trials && name == "correct") return "recall"
  if (has_trials && name ~ /^(wrong|false)$/) return "false"
  return ""
}

function heading(   i, kind) {
  num_columns = num_kinds = has_trials = 0
  first_kind = 0
  for (i = 1; i <= n; ++i) if (cells[i] == "trials") has_trials = i
  for (i = 1; i <= n; ++i) {
    kind = kind_of(cells[i])
    kinds[i] = kind
    names[i] = cells[i]
    if (kind != "") ++num_kinds
    if (kind != "" && !first_kind) first_kind = i
  }
  num_columns = n
}

# The cells before the first measured column, up to the first with a decimal point.
function label(   i, end, text) {
  end = has_trials && has_trials < first_kind ? has_trials : first_kind
  for (i = 1; i < end && cells[i] !~ /^-?[0-9]+\.[0-9]/; ++i) text = text (i > 1 ? ", " : "") cells[i]
  return text
}

function data(   i, value) {
  for (i = 1; i <= n; ++i) {
    if (kinds[i] == "" || cells[i] !~ /^[0-9]/) continue
    value = first_number(cells[i])
    if (has_trials && kinds[i] == "recall") value = cells[has_trials] + 0 ? sprintf("%.4f", value / cells[has_trials]) : ""
    put(label() ": " names[i], kinds[i], value)
  }
}

FNR == 1 { row = FILENAME; sub(/\.txt$/, "", row); num_kinds = num_columns = 0 }
/^#/ || NF == 0 { next }
{
  line = $0
  sub(/^ +/, "", line)
  sub(/ +$/, "", line)
  n = split(line, cells, /  +/)
  if (n > 2) for (i = 1; i <= n; ++i) cells[i] = today(cells[i])
  if (n == 2) figure(cells[1], cells[2])
  if (n == num_columns && num_kinds && $0 !~ /^ /) data()
  else if (n > 2 && $0 !~ /^ / && cells[n] !~ /^[0-9]/) heading()
}
