using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Voxtet
{
    /// <summary>A call of the library failed. The text is the library's, with the numbers in it.</summary>
    public class VoxException : Exception
    {
        /// <summary>What kind of failure it is.</summary>
        public Result Code { get; private set; }

        public VoxException(Result code, string text) : base(text)
        {
            Code = code;
        }

        internal static void Check(Result result)
        {
            if (result != Result.Ok) Throw(result);
        }

        static void Throw(Result result)
        {
            string text = Text(Native.vox_last_error()); // of this thread, before anything else runs on it
            switch (result)
            {
                case Result.ErrorInvalidArgument:
                case Result.ErrorInvalidMesh:
                case Result.ErrorFormat:
                    throw new VoxArgumentException(result, text);
                default:
                    throw new VoxException(result, text);
            }
        }

        internal static unsafe string Text(IntPtr utf8)
        {
            if (utf8 == IntPtr.Zero) return "";
            byte* text = (byte*)utf8;
            int length = 0;
            while (text[length] != 0) ++length;
            return Encoding.UTF8.GetString(text, length);
        }

        internal static byte[] Utf8(string text)
        {
            if (text == null) throw new ArgumentNullException("text");
            if (text.IndexOf('\0') >= 0) throw new ArgumentException("'" + text + "' has a zero character in it");
            return Encoding.UTF8.GetBytes(text + "\0");
        }

        static bool matches;

        /// <summary>Refuses a library of another interface than the one this assembly was made for.</summary>
        internal static void CheckLibrary()
        {
            if (matches) return;
            uint library = Native.vox_abi_version();
            if (library != Native.VOX_ABI_VERSION)
                throw new VoxException(Result.ErrorUnsupported, "libvox has ABI version " + library +
                                       ", this assembly was made for " + Native.VOX_ABI_VERSION);
            matches = true;
        }
    }

    /// <summary>An argument, a mesh or a file is not as it has to be.</summary>
    public class VoxArgumentException : VoxException
    {
        public VoxArgumentException(Result code, string text) : base(code, text) { }
    }
}
