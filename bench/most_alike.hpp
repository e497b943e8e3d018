#pragma once

#include <vector>

namespace samewhere::bench {

// Of two vectors of equal length.
float dot(const std::vector<float>& a, const std::vector<float>& b);

// The `count` of `offered` most like `query` by dot product, the most alike first; ties by index.
std::vector<int> most_alike(const std::vector<std::vector<float>>& vectors, int query,
                            const std::vector<int>& offered, int count);

}  // namespace samewhere::bench
