#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>
#include <torch/nn/init.h>
#include <torch/nn/modules/linear.h>
#include <torch/utils.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/head_network.hpp>
#include <samewhere/train/torch_layers.hpp>

namespace samewhere::train {
namespace {

using torch::Tensor;

constexpr double kFirstPower = 3.0;
constexpr float kSmallest = 1e-6F;        // of what is raised to a power
constexpr double kFirstSharpness = 10.0;  // of the soft assignment
constexpr int kLloydSteps = 10;
constexpr int kPositionStep = 8;  // of the positions of all maps one of so many

Tensor matrix_of(std::int64_t rows, std::int64_t columns) {
  return torch::zeros({rows, columns}, torch::requires_grad());
}

// Centred and of length 1.
Tensor compared(const Tensor& codes) {
  const Tensor centred = codes - codes.mean(1, true);
  return centred / (centred.norm(2, 1, true) + kSmallest);
}

class HeadLayers : public torch::nn::Module {
 public:
  HeadLayers(HeadKind of_kind, const MapShape& map, const HeadConfig& settings)
      : kind(of_kind), shape(map), config(settings) {
    power = register_parameter("power", torch::full({1}, kFirstPower));
    if (kind == HeadKind::kNetvlad) {
      reduce = register_parameter("reduce", matrix_of(kReducedChannels, shape.channels));
      reduce_bias = register_parameter("reduce_bias", torch::zeros({kReducedChannels}));
      assign = register_parameter("assign", matrix_of(config.clusters, kReducedChannels));
      assign_bias = register_parameter("assign_bias", torch::zeros({config.clusters}));
      centres = register_parameter("centres", matrix_of(config.clusters, kReducedChannels));
    }
    project = register_parameter("project", matrix_of(config.code_size, pooled_size()));
    project_bias = register_parameter("project_bias", torch::zeros({config.code_size}));
  }

  std::int64_t pooled_size() const {
    if (kind == HeadKind::kGem) return shape.channels;
    if (kind == HeadKind::kNetvlad) return std::int64_t{config.clusters} * kReducedChannels;
    return std::int64_t{shape.channels} * kDarknetParts * kDarknetParts;
  }

  // Positions' reduced features of length 1: views x reduced x positions.
  Tensor local(const Tensor& maps) const {
    const Tensor x = torch::matmul(reduce, maps.flatten(2)) + reduce_bias.view({1, -1, 1});
    return x * torch::rsqrt(kNetvladFloor + x.square().sum(1, true));
  }

  // Residuals x clusters, each cluster of length 1.
  Tensor vlad(const Tensor& maps) const {
    const Tensor x = local(maps);
    const Tensor share = torch::softmax(torch::matmul(assign, x) + assign_bias.view({1, -1, 1}), 1);
    const Tensor sums = torch::matmul(x, share.transpose(1, 2));  // views x reduced x clusters
    const Tensor residual = sums - centres.t().unsqueeze(0) * share.sum(2).unsqueeze(1);
    return residual * torch::rsqrt(kNetvladFloor + residual.square().sum(1, true));
  }

  Tensor pooled(const Tensor& maps) const {
    if (kind == HeadKind::kGem) {
      const Tensor raised = torch::pow(maps.clamp_min(kSmallest), power);
      return torch::pow(raised.mean({2, 3}), 1.0 / power);
    }
    if (kind == HeadKind::kNetvlad) return vlad(maps).flatten(1);
    const std::int64_t side[] = {shape.rows / kDarknetParts, shape.columns / kDarknetParts};
    return torch::avg_pool2d(maps, side, side).flatten(1);
  }

  Tensor forward(const Tensor& maps) const {
    return torch::addmm(project_bias, pooled(maps), project.t());
  }

  HeadKind kind;
  MapShape shape;
  HeadConfig config;
  Tensor power, reduce, reduce_bias, assign, assign_bias, centres, project, project_bias;
};

struct Whitening {
  Tensor weights;
  Tensor biases;
};

// The `size` strongest principal components of rows, each of variance 1.
Whitening whitening_of(const Tensor& rows, int size) {
  const Tensor mean = rows.mean(0);
  const Tensor centred = (rows - mean).to(torch::kDouble);
  const Tensor covariance =
      (torch::matmul(centred.t(), centred) / static_cast<double>(rows.size(0))).contiguous();
  const auto length = covariance.size(0);
  const Eigen::Map<const Eigen::MatrixXd> matrix(covariance.data_ptr<double>(), length, length);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  const double floor = 1e-3 * solver.eigenvalues()(length - 1);  // noise is not blown up
  Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> weights(size, length);
  for (int i = 0; i < size; ++i) {
    const auto column = length - 1 - i;
    weights.row(i) = (solver.eigenvectors().col(column) /
                      std::sqrt(std::max(solver.eigenvalues()(column), 0.0) + floor))
                         .cast<float>();
  }
  const Tensor result =
      torch::from_blob(weights.data(), {static_cast<std::int64_t>(size), length}).clone();
  return {result, -torch::mv(result, mean)};
}

// Lloyd's algorithm from evenly spread rows.
Tensor means_of(const Tensor& rows, int count) {
  Tensor means = rows.index_select(
      0, torch::linspace(0.0, static_cast<double>(rows.size(0) - 1), count).to(torch::kLong));
  for (int step = 0; step < kLloydSteps; ++step) {
    const Tensor nearest = (2.0 * torch::matmul(rows, means.t()) - means.square().sum(1)).argmax(1);
    const Tensor sums = torch::zeros_like(means).index_add_(0, nearest, rows);
    const Tensor counts = torch::zeros({count}).index_add_(0, nearest, torch::ones({rows.size(0)}));
    means = torch::where(counts.unsqueeze(1) > 0, sums / counts.clamp_min(1.0).unsqueeze(1), means);
  }
  return means;
}

// The mean of margin + negative - positive over all triplets for which it is above 0.
Tensor triplet_loss(const Tensor& codes, const HeadBatch& batch, double margin) {
  const Tensor similarity = torch::matmul(codes, codes.t());
  std::vector<float> same;
  std::vector<float> different;
  for (const Relation relation : batch.relations) {
    same.push_back(relation == Relation::kSame ? 1.0F : 0.0F);
    different.push_back(relation == Relation::kDifferent ? 1.0F : 0.0F);
  }
  const std::int64_t n = batch.num_views;
  const Tensor counts =
      tensor_of(same, {n, n}).unsqueeze(2) * tensor_of(different, {n, n}).unsqueeze(1);
  const Tensor loss =
      torch::relu(margin + similarity.unsqueeze(1) - similarity.unsqueeze(2)) * counts;
  return loss.sum() / (loss > 0.0).sum().clamp_min(1);
}

void set_to(Tensor& parameter, const std::vector<float>& numbers) {
  if (numbers.empty()) return;
  parameter.copy_(
      tensor_of(numbers, {static_cast<std::int64_t>(numbers.size())}).view(parameter.sizes()));
}

}  // namespace

struct HeadNetwork::Network {
  Network(HeadKind kind, const MapShape& shape, const HeadConfig& config)
      : layers(kind, shape, config), adam(layers.parameters(), torch::optim::AdamOptions()) {}

  Tensor tensor(std::span<const float> maps) const {
    const MapShape& shape = layers.shape;
    const auto num_views = static_cast<std::int64_t>(maps.size()) / shape.size();
    return tensor_of(maps, {num_views, shape.channels, shape.rows, shape.columns});
  }

  HeadLayers layers;
  torch::optim::Adam adam;
};

HeadNetwork::HeadNetwork(HeadKind kind, const MapShape& shape, const HeadConfig& config) {
  if (kind == HeadKind::kDarknet &&
      (shape.rows % kDarknetParts != 0 || shape.columns % kDarknetParts != 0)) {
    throw core::InputError(
        fmt::format("darknet: the feature map has {} x {} positions, expected "
                    "multiples of {}",
                    shape.rows, shape.columns, kDarknetParts));
  }
  torch::manual_seed(static_cast<std::uint64_t>(config.seed));
  network_ = std::make_unique<Network>(kind, shape, config);
}

HeadNetwork::~HeadNetwork() = default;

void HeadNetwork::initialize(std::span<const float> maps) {
  const torch::NoGradGuard no_gradient;
  HeadLayers& layers = network_->layers;
  const Tensor all = network_->tensor(maps);
  if (all.size(0) < layers.config.code_size) {
    throw core::InputError(fmt::format("{} views to start from, expected at least code_size = {}",
                                       all.size(0), layers.config.code_size));
  }
  if (layers.kind == HeadKind::kNetvlad) {
    const Tensor positions = all.flatten(2).transpose(1, 2).reshape({-1, layers.shape.channels});
    const Whitening reduction =
        whitening_of(positions.slice(0, 0, positions.size(0), kPositionStep), kReducedChannels);
    layers.reduce.copy_(reduction.weights);
    layers.reduce_bias.copy_(reduction.biases);
    const Tensor local = layers.local(all).transpose(1, 2).reshape({-1, kReducedChannels});
    const Tensor means = means_of(local, layers.config.clusters);
    layers.centres.copy_(means);
    layers.assign.copy_(2.0 * kFirstSharpness * means);
    layers.assign_bias.copy_(-kFirstSharpness * means.square().sum(1));
  }
  const Whitening projection = whitening_of(layers.pooled(all), layers.config.code_size);
  layers.project.copy_(projection.weights);
  layers.project_bias.copy_(projection.biases);
}

double HeadNetwork::learn(const HeadBatch& batch, double learning_rate) {
  const Tensor codes = compared(network_->layers.forward(network_->tensor(batch.maps)));
  const Tensor loss = triplet_loss(codes, batch, network_->layers.config.margin);
  step_down(loss, learning_rate, network_->adam);
  return loss.item<double>();
}

std::vector<float> HeadNetwork::codes(std::span<const float> maps) {
  const torch::NoGradGuard no_gradient;
  return numbers_of(network_->layers.forward(network_->tensor(maps)));
}

HeadWeights HeadNetwork::weights() const {
  const torch::NoGradGuard no_gradient;
  const HeadLayers& layers = network_->layers;
  HeadWeights weights{.kind = layers.kind,
                      .shape = layers.shape,
                      .code_size = layers.config.code_size,
                      .power = layers.power.item<float>()};
  if (layers.kind == HeadKind::kNetvlad) {
    weights.reduced = kReducedChannels;
    weights.clusters = layers.config.clusters;
    weights.reduce_weights = numbers_of(layers.reduce);
    weights.reduce_biases = numbers_of(layers.reduce_bias);
    weights.assign_weights = numbers_of(layers.assign);
    weights.assign_biases = numbers_of(layers.assign_bias);
    weights.centres = numbers_of(layers.centres);
  }
  weights.project_weights = numbers_of(layers.project);
  weights.project_biases = numbers_of(layers.project_bias);
  return weights;
}

void HeadNetwork::restore(const HeadWeights& weights) {
  const torch::NoGradGuard no_gradient;
  HeadLayers& layers = network_->layers;
  layers.power.fill_(weights.power);
  set_to(layers.reduce, weights.reduce_weights);
  set_to(layers.reduce_bias, weights.reduce_biases);
  set_to(layers.assign, weights.assign_weights);
  set_to(layers.assign_bias, weights.assign_biases);
  set_to(layers.centres, weights.centres);
  set_to(layers.project, weights.project_weights);
  set_to(layers.project_bias, weights.project_biases);
}

}  // namespace samewhere::train
