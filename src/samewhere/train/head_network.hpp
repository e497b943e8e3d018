#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <samewhere/train/head_config.hpp>
#include <samewhere/train/head_views.hpp>

namespace samewhere::train {

// What makes a vector of a feature map. A kind leaves empty what it does not have.
struct HeadWeights {
  HeadKind kind = HeadKind::kGem;
  MapShape shape;
  int code_size = 0;
  float power = 1.0F;  // GeM (Radenovic et al. 2019)
  int reduced = 0;     // NetVLAD (Arandjelovic et al. 2016): channels that are kept
  int clusters = 0;
  std::vector<float> reduce_weights;  // reduced x channels
  std::vector<float> reduce_biases;
  std::vector<float> assign_weights;  // clusters x reduced
  std::vector<float> assign_biases;
  std::vector<float> centres;          // clusters x reduced
  std::vector<float> project_weights;  // code_size x length of what was pooled
  std::vector<float> project_biases;
};

// Channels that NetVLAD keeps, and the floor below the norm of a position's.
inline constexpr int kReducedChannels = 64;
inline constexpr float kNetvladFloor = 1e-4F;
// DarkNet's map is averaged in as many parts a side.
inline constexpr int kDarknetParts = 2;

// A batch: feature maps one after the other, and how each two are related, row by row.
struct HeadBatch {
  int num_views = 0;
  std::vector<float> maps;
  std::vector<Relation> relations;
};

// A head that learns (libtorch, Adam): pooled features, projected, centred and of length 1, so that
// the inner product is the NCC. The loss is the triplet loss on it, the mean over all triplets of
// the batch that violate the margin. On one thread the same calls give the same bits.
class HeadNetwork {
 public:
  // Weights are drawn by config.seed. Throws InputError if the head does not fit the map.
  HeadNetwork(HeadKind kind, const MapShape& shape, const HeadConfig& config);
  HeadNetwork(const HeadNetwork&) = delete;
  HeadNetwork& operator=(const HeadNetwork&) = delete;
  ~HeadNetwork();

  // Starts from what the maps themselves say: clusters by k-means, projection by whitening (PCA).
  // `maps` as in HeadBatch; at least code_size of them, else InputError.
  void initialize(std::span<const float> maps);
  // One step down the gradient; returns the loss before it.
  double learn(const HeadBatch& batch, double learning_rate);
  // Vectors, neither centred nor scaled, one after the other.
  std::vector<float> codes(std::span<const float> maps);

  HeadWeights weights() const;
  void restore(const HeadWeights& weights);

 private:
  struct Network;
  std::unique_ptr<Network> network_;
};

}  // namespace samewhere::train
