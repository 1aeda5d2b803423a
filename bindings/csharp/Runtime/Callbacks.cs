using System;
using System.Runtime.InteropServices;

#if !UNITY_5_3_OR_NEWER
namespace AOT
{
    /// <summary>Unity's ahead-of-time compiler asks for it on methods that native code calls, and finds it by name.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    sealed class MonoPInvokeCallbackAttribute : Attribute
    {
        public MonoPInvokeCallbackAttribute(Type type) { }
    }
}
#endif

namespace Voxtet
{
    /// <summary>The distance of a point from a shape, in the frame of the shape. Outside it is at most the true distance, inside
    /// it is not above 0. The gradient points out of the shape. It is called on several threads at once.</summary>
    public delegate double FieldFunction(Double3 point, out Double3 gradient);

    /// <summary>A field that the library calls. One that throws gives no distance, and the step fails.</summary>
    static unsafe class FieldCall
    {
        internal static readonly ShapeDescField Call = Evaluate; // never collected

        [AOT.MonoPInvokeCallback(typeof(ShapeDescField))]
        static void Evaluate(double* points, ulong count, double* distances, double* gradients, IntPtr user)
        {
            for (ulong i = 0; i < count; ++i)
                try
                {
                    distances[i] = double.NaN;
                    var field = (FieldFunction)GCHandle.FromIntPtr(user).Target;
                    distances[i] = field(((Double3*)points)[i], out ((Double3*)gradients)[i]);
                }
                catch (Exception error)
                {
                    System.Diagnostics.Debug.WriteLine(error);
                }
        }
    }

    /// <summary>Functions of the caller that the library calls. An exception must not cross it.</summary>
    sealed class Callbacks
    {
        readonly Action<LogLevel, string> log;
        GCHandle self;

        static readonly LogWrite write = Write; // never collected

        internal Callbacks(Action<LogLevel, string> log)
        {
            this.log = log;
            self = GCHandle.Alloc(this, GCHandleType.Weak); // the grid holds this, and a log may hold its grid
        }

        internal Log Describe()
        {
            return new Log { write = Marshal.GetFunctionPointerForDelegate(write), user = GCHandle.ToIntPtr(self) };
        }

        internal void Free()
        {
            if (self.IsAllocated) self.Free();
        }

        [AOT.MonoPInvokeCallback(typeof(LogWrite))]
        static void Write(LogLevel level, IntPtr text, IntPtr user)
        {
            try
            {
                var callbacks = (Callbacks)GCHandle.FromIntPtr(user).Target;
                if (callbacks != null) callbacks.log(level, VoxException.Text(text)); // null while the grid is collected
            }
            catch (Exception error) // its line is lost
            {
                System.Diagnostics.Debug.WriteLine(error);
            }
        }
    }
}
