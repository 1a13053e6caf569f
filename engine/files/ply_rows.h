// The rows of a PLY element as float32 columns, for any encoding and property types.
#pragma once

#include "engine/files/ply_header.h"
#include "engine/files/stored_block.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace binosplat::ply {

// The target of a property: `attribute` of a StoredBlock.
struct Column {
    std::size_t property;
    int attribute;
};

class RowReader {
public:
    virtual ~RowReader() = default;
    // Fills `block` with its next rows (block.rows of them). Throws Error with the splat's number if the file
    // ends or a value is not a number.
    virtual void read(StoredBlock& block) = 0;
    // Fills `block` with sample rows before the first is read: from all over the element, or the first ones
    // of an ascii file.
    virtual void sample(StoredBlock& block) const = 0;
    // float64 positions are relative to this from now on.
    virtual void countFrom(const glm::dvec3& origin) = 0;
};

// Skips an element that is not needed.
void skipElement(InputFile& file, Encoding encoding, const Element& element);

// Checks the element's size against the rest of the file, then returns its reader. The element must not have
// a list.
std::unique_ptr<RowReader> openRows(InputFile& file, const Header& header, const Element& element,
                                    std::vector<Column> columns);

}  // namespace binosplat::ply
