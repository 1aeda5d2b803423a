// What a body was like in the last step, for the model of the fast engine: one that rests costs nothing where
// it meets another one at rest, or itself; one that is cleared by winding numbers costs nothing where it
// meets itself.
#pragma once

namespace vox {

struct Activity {
    bool moves = true, meets_itself = true;
};

} // namespace vox
