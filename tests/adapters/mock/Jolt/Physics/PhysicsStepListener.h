#pragma once

namespace JPH {

class PhysicsStepListenerContext {
public:
    float mDeltaTime;
};

class PhysicsStepListener {
public:
    virtual ~PhysicsStepListener() = default;
    virtual void OnStep(const PhysicsStepListenerContext& context) = 0;
};

} // namespace JPH
