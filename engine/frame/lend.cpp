// Frames that a program submits.
#include "engine/frame/stereo_frame.h"

#include <cassert>
#include <utility>

namespace binosplat {

StereoFrame::Lent StereoFrame::lend(std::span<const Eye> eyes, const FrameSettings& settings,
                                    const Append& append) {
    finish();
    // Whatever is freed from here on stays until the earlier frames have come back.
    const std::uint64_t number = context_.freedBuffers().beginFrame();
    try {
        if (idle_.empty()) {
            idle_.push_back(std::make_unique<Flight>(context_, Commands::Level::kSecondary));
        }
        std::unique_ptr<Flight>& flight = lent_[number] = std::move(idle_.back());
        idle_.pop_back();
        if (FrameMemory::isCutShort(state_)) {
            memory_.growIfItFits(plan_, state_);
        } else if (!plan_.targets.empty() && memory_.fitsAhead() &&
                   !memory_.hasCapacity(plan_, stateAhead(), kCapacityAhead)) {
            memory_.growAhead(plan_, stateAhead());
        }
        prepare(eyes, settings);
        record(*flight, settings, append);
        return {number, flight->commands.lend()};
    } catch (...) {
        takeBackUnused(number);
        throw;
    }
}

FrameResult StereoFrame::takeBack(std::uint64_t number) {
    std::unique_ptr<Flight> flight = std::move(lent_.at(number));
    lent_.erase(number);
    FrameResult result = land(*flight).value();
    idle_.push_back(std::move(flight));
    context_.freedBuffers().endFrame(number);
    return result;
}

void StereoFrame::takeBackUnused(std::uint64_t number) {
    if (const auto found = lent_.find(number); found != lent_.end()) {
        if (found->second->commands.isUnderWay()) { found->second->commands.drop(); }
        idle_.push_back(std::move(found->second));
        lent_.erase(found);
    }
    histories_ = {};  // part of what it should have left is missing
    context_.freedBuffers().endFrame(number);
}

}  // namespace binosplat
