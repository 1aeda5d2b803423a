#pragma once

#include <Jolt/Jolt.h>

namespace JPH {

class SoftBodySharedSettings {
public:
    struct Face {
        uint32 mVertex[3];
    };
    struct Edge {
        uint32 mVertex[2];
        float mRestLength;
        float mCompliance;
    };
    struct Volume {
        uint32 mVertex[4];
        float mSixRestVolume;
        float mCompliance;
    };
    Array<Face> mFaces;
    Array<Edge> mEdgeConstraints;
    Array<Volume> mVolumeConstraints;
};

} // namespace JPH
