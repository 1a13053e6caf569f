// A ring of batches between two threads.
#include "engine/files/read_ahead.h"

#include <algorithm>
#include <utility>

namespace binosplat {

ReadAhead::ReadAhead(std::uint64_t rows, std::function<void(Block&)> fill)
    : rows_left_(rows), fill_(std::move(fill)) {
    const bool threaded = rows > 2 * std::tuple_size_v<decltype(Batch::blocks)> * StoredBlock::kRows;
    batches_.resize(threaded ? kBatches : 1);
    if (threaded) { thread_ = std::thread(&ReadAhead::run, this); }
}

ReadAhead::~ReadAhead() {
    stops_ = true;
    free_.release();
    if (thread_.joinable()) { thread_.join(); }
}

void ReadAhead::fillBatch(Batch& batch) {
    batch.count = 0;
    try {
        for (; batch.count < batch.blocks.size() && rows_left_ > 0; ++batch.count) {
            Block& block = batch.blocks[batch.count];
            block.stored.rows =
                static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, rows_left_));
            fill_(block);
            rows_left_ -= block.stored.rows;
        }
    } catch (...) { batch.failure = std::current_exception(); }
}

void ReadAhead::run() {
    // A batch without a block ends the sequence.
    for (std::size_t i = 0;; i = (i + 1) % batches_.size()) {
        free_.acquire();
        if (stops_) { return; }
        fillBatch(batches_[i]);
        const bool last = batches_[i].count == 0 || batches_[i].failure;
        filled_.release();
        if (last) { return; }
    }
}

const ReadAhead::Block* ReadAhead::next() {
    if (holds_batch_ && taken_ < batches_[batch_].count) { return &batches_[batch_].blocks[taken_++]; }
    if (holds_batch_) {
        if (batches_[batch_].failure) { std::rethrow_exception(batches_[batch_].failure); }
        if (batches_[batch_].count == 0) { return nullptr; }
        batch_ = (batch_ + 1) % batches_.size();
        if (thread_.joinable()) { free_.release(); }
    }
    if (thread_.joinable()) {
        filled_.acquire();
    } else {
        fillBatch(batches_[batch_]);
    }
    holds_batch_ = true;
    taken_ = 0;
    return next();
}

}  // namespace binosplat
