#pragma once

#include <memory>

#include <opencv2/core/mat.hpp>

#include <samewhere/describe/describer.hpp>

namespace samewhere::describe {

// Describes a view by the code of a trained network, config.network (section 3.1.2 of the published
// method): the preprocessed picture, reduced to the network's input and scaled to [0, 1]. A view of
// one grey level is all zero, whatever the network would make of it. describe() throws InputError
// naming the network if its code is not finite.
// A network of another input than grey is make_network_describer's (network_describer.hpp).
// Throws InputError as network::find_network, read_network and make_inference do, and if the
// network's output is not 1xN with N at least 2.
std::unique_ptr<Describer> make_autoencoder(const Config& config);

// What a network is fed, in use and in training: a view as preprocess() gives it, reduced by
// averaging over the area (enlarged linearly, if that is asked for) to 32-bit floats in [0, 1].
cv::Mat network_input(const cv::Mat& prepared, cv::Size input_px);

}  // namespace samewhere::describe
