// Two names from left to right, a letter or a number at a time.
#include "app/view/scenes/natural_order.h"

#include <algorithm>

namespace binosplat {

namespace {

bool isDigit(char letter) { return letter >= '0' && letter <= '9'; }

unsigned char folded(char letter) {
    const char small = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    return static_cast<unsigned char>(small);
}

// The digits that `name` begins with, without zeros in front, taken away from it.
std::string_view takeNumber(std::string_view& name) {
    const std::size_t zeros = std::min(name.find_first_not_of('0'), name.size());
    const std::size_t end = std::min(name.find_first_not_of("0123456789", zeros), name.size());
    const std::string_view number = name.substr(zeros, end - zeros);
    name.remove_prefix(end);
    return number;
}

}  // namespace

bool comesBefore(std::string_view a, std::string_view b) {
    std::string_view rest_a = a, rest_b = b;
    while (!rest_a.empty() && !rest_b.empty()) {
        if (isDigit(rest_a.front()) && isDigit(rest_b.front())) {
            const std::string_view number_a = takeNumber(rest_a), number_b = takeNumber(rest_b);
            if (number_a.size() != number_b.size()) { return number_a.size() < number_b.size(); }
            if (number_a != number_b) { return number_a < number_b; }
            continue;
        }
        const unsigned char letter_a = folded(rest_a.front()), letter_b = folded(rest_b.front());
        if (letter_a != letter_b) { return letter_a < letter_b; }
        rest_a.remove_prefix(1);
        rest_b.remove_prefix(1);
    }
    if (rest_a.empty() != rest_b.empty()) { return rest_a.empty(); }
    return a < b;
}

}  // namespace binosplat
