// A row for each order, for machines and for people.
#include "app/bench/order_results.h"

#include "app/bench/bench_results.h"

#include <fmt/format.h>

namespace binosplat {

std::string ordersCsv(const std::vector<OrderResult>& results) {
    std::string csv =
        "point,width,height,order,psnr_to_own_db,share_off_own,psnr_to_depth_db,share_off_depth,popped_eyes,"
        "popped_eyes_most,popped_neck,"
        "popped_neck_most\n";
    for (const OrderResult& r : results) {
        csv += fmt::format("{},{},{},{},{:.4f},{:.6g},{:.4f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
                           csvCell(r.point), r.size_px.x, r.size_px.y, csvCell(r.method),
                           psnrOf(r.from_own.mean_square), r.from_own.share_off,
                           psnrOf(r.from_depth.mean_square), r.from_depth.share_off, r.popped_eyes,
                           r.most_eyes, r.popped_neck, r.most_neck);
    }
    return csv;
}

std::string ordersTable(const std::vector<OrderResult>& results) {
    std::string table = fmt::format(
        "Off: pixels that differ by more than 2/255 from those of each pixel's own order. Popped: pixels "
        "that change as much from one "
        "turn\n"
        "of {} degrees to the next by the order alone, mean of {}: about the midpoint between the eyes, and "
        "about a neck {} m behind it.\n",
        kTurnDegrees, kTurns, kNeckMetres);
    std::string point;
    for (const OrderResult& r : results) {
        if (r.point != point) {
            point = r.point;
            table +=
                fmt::format("\n{}, {}x{}\n  {:<22} {:>9} {:>9} {:>12} {:>11} {:>11}\n", point, r.size_px.x,
                            r.size_px.y, "order", "dB", "off %", "dB to depth", "popped %", "neck %");
        }
        table += fmt::format("  {:<22} {:>9.2f} {:>9.3f} {:>12.2f} {:>11.4f} {:>11.4f}\n", r.method,
                             psnrOf(r.from_own.mean_square), 100.0 * r.from_own.share_off,
                             psnrOf(r.from_depth.mean_square), 100.0 * r.popped_eyes, 100.0 * r.popped_neck);
    }
    return table;
}

}  // namespace binosplat
