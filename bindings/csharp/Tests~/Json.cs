using System;
using System.Collections.Generic;
using System.Globalization;
using System.Text;

namespace Voxtet.Tests
{
    /// <summary>As much JSON as the vectors have: objects, arrays, text without escapes, numbers.</summary>
    static class Json
    {
        public static object Parse(string text)
        {
            int at = 0;
            return Value(text, ref at);
        }

        static char Next(string text, ref int at)
        {
            while (char.IsWhiteSpace(text[at])) ++at;
            return text[at];
        }

        static object Value(string text, ref int at)
        {
            switch (Next(text, ref at))
            {
                case '{':
                    var found = new Dictionary<string, object>();
                    ++at;
                    while (Next(text, ref at) != '}')
                    {
                        if (text[at] == ',') { ++at; continue; }
                        string name = Text(text, ref at);
                        if (Next(text, ref at) != ':') throw new FormatException("':' expected at " + at);
                        ++at;
                        found[name] = Value(text, ref at);
                    }
                    ++at;
                    return found;
                case '[':
                    var list = new List<object>();
                    ++at;
                    while (Next(text, ref at) != ']')
                    {
                        if (text[at] == ',') { ++at; continue; }
                        list.Add(Value(text, ref at));
                    }
                    ++at;
                    return list;
                case '"':
                    return Text(text, ref at);
                default:
                    int begin = at;
                    while ("+-.eE0123456789".IndexOf(text[at]) >= 0) ++at;
                    return double.Parse(text.Substring(begin, at - begin), CultureInfo.InvariantCulture);
            }
        }

        static string Text(string text, ref int at)
        {
            if (Next(text, ref at) != '"') throw new FormatException("text expected at " + at);
            int end = text.IndexOf('"', at + 1);
            string found = text.Substring(at + 1, end - at - 1);
            at = end + 1;
            return found;
        }
    }
}
