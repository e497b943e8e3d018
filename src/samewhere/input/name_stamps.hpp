#pragma once

#include <string>
#include <vector>

namespace samewhere::input {

// What the numbers in the names of pictures say: their order and their stamps.

// Sorts the names by value if all are decimal numbers, at least one with a point: 1611234567.99.png
// before 1611234568.2.png before 1611234568.23.png. Seconds and a count of nano- or microseconds
// without leading zeros, as in 12.5000000 and 12.38000000, are recognised. Else the names, or those
// of which two have the same value, stay as they are.
void order_by_decimals(std::vector<std::string>& names);

struct NameStamps {
  std::vector<double> stamps_s;  // one per name, rising strictly
  bool are_times = false;        // from the names, whatever the frame rate is
  std::string remark;            // what a reader should be warned of; empty: nothing
};

// The stamps of pictures with these names, in this order, at least one. The last number of a name
// counts. Decimal numbers, and numbers since 1970 of 10, 13, 16 or 19 digits, are seconds (or
// milli-, micro-, nanoseconds). Numbers that rise by about one are frame numbers: number / fps;
// also those that rise by a few, or by one round step throughout (each tenth frame). Numbers that
// rise regularly by another step are milli-, micro- or nanoseconds, whichever makes it the time
// between two frames; nine digits may be a time of day, hhmmssmmm. Everything else: position / fps.
// With is_fps_given only frame numbers and positions count.
NameStamps stamps_from_names(const std::vector<std::string>& names, double fps, bool is_fps_given);

}  // namespace samewhere::input
