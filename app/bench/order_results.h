// The results of a bench of orders.
#pragma once

#include <glm/glm.hpp>

#include <string>
#include <vector>

namespace binosplat {

// How far the head turns, how often, and how far behind the midpoint between the eyes its neck is.
constexpr double kTurnDegrees = 0.1, kNeckMetres = 0.1;
constexpr int kTurns = 20;

struct OrderChange {
    double mean_square = 0.0;  // of R, G and B
    double share_off = 0.0;    // of pixels in which any of these is off by more than two display steps
};

struct OrderResult {
    std::string point, method;
    glm::uvec2 size_px;
    OrderChange from_own, from_depth;
    // Shares of pixels that change from one turn to the next only because of the order: mean and most.
    double popped_eyes = 0.0, most_eyes = 0.0, popped_neck = 0.0, most_neck = 0.0;
};

std::string ordersCsv(const std::vector<OrderResult>& results);
std::string ordersTable(const std::vector<OrderResult>& results);

}  // namespace binosplat
