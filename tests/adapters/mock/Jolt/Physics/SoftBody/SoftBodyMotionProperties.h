#pragma once

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/SoftBody/SoftBodySharedSettings.h>

namespace JPH {

class SoftBodyVertex {
public:
    Vec3 mPreviousPosition, mPosition, mVelocity;
    float mInvMass;
};

class SoftBodyMotionProperties : public MotionProperties {
public:
    const SoftBodySharedSettings* GetSettings() const { return settings; }
    Array<SoftBodyVertex>& GetVertices() { return vertices; }
    const Array<SoftBodyVertex>& GetVertices() const { return vertices; }

    // Extended position based dynamics, as Jolt does it: in each of five parts of a step vertices move,
    // constraints are solved once, and velocities follow. The floor is at y = 0.
    void Update(const Body& body, float seconds, float gravity) {
        const float dt = seconds / 5;
        for (int part = 0; part < 5; ++part) {
            for (SoftBodyVertex& v : vertices) {
                v.mPreviousPosition = v.mPosition;
                if (v.mInvMass > 0) v.mVelocity += Vec3(0, gravity * dt, 0);
                v.mPosition += dt * v.mVelocity;
            }
            for (const auto& c : settings->mVolumeConstraints) SolveVolume(c, dt);
            for (const auto& c : settings->mEdgeConstraints) SolveEdge(c, dt);
            for (SoftBodyVertex& v : vertices) {
                const float depth = -(body.transform.GetTranslation().GetY() + v.mPosition.GetY());
                const bool rests = depth > 0 && v.mInvMass > 0;
                if (rests) v.mPosition += Vec3(0, depth, 0);
                v.mVelocity = 1 / dt * (v.mPosition - v.mPreviousPosition);
                if (rests) v.mVelocity = Vec3::sZero();
            }
        }
    }

    const SoftBodySharedSettings* settings = nullptr;
    Array<SoftBodyVertex> vertices;

private:
    void SolveEdge(const SoftBodySharedSettings::Edge& c, float dt) {
        SoftBodyVertex &a = vertices[c.mVertex[0]], &b = vertices[c.mVertex[1]];
        const Vec3 way = b.mPosition - a.mPosition;
        const float length = way.Length();
        const float f =
            (length - c.mRestLength) / (length * (a.mInvMass + b.mInvMass + c.mCompliance / (dt * dt)));
        a.mPosition += a.mInvMass * f * way;
        b.mPosition += -b.mInvMass * f * way;
    }

    void SolveVolume(const SoftBodySharedSettings::Volume& c, float dt) {
        SoftBodyVertex* v[4];
        for (int k = 0; k < 4; ++k) v[k] = &vertices[c.mVertex[k]];
        const Vec3 x1 = v[1]->mPosition - v[0]->mPosition, x2 = v[2]->mPosition - v[0]->mPosition,
                   x3 = v[3]->mPosition - v[0]->mPosition;
        Vec3 gradient[4] = {Vec3(), x2.Cross(x3), x3.Cross(x1), x1.Cross(x2)};
        gradient[0] = -1.f * (gradient[1] + gradient[2] + gradient[3]);
        const float six = gradient[3].Dot(x3);
        float sum = c.mCompliance / (dt * dt);
        for (int k = 0; k < 4; ++k) sum += v[k]->mInvMass * gradient[k].Dot(gradient[k]);
        const float f = (six - (six < 0 ? -c.mSixRestVolume : c.mSixRestVolume)) / sum;
        for (int k = 0; k < 4; ++k) v[k]->mPosition += -f * v[k]->mInvMass * gradient[k];
    }
};

} // namespace JPH
