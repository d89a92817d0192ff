// A discrete distribution by the alias method (Walker 1977, Vose 1991), decided in integers.

#ifndef TANDEM_SAMPLING_ALIAS_TABLE
#define TANDEM_SAMPLING_ALIAS_TABLE

/// One of `count` equally likely indices, without bias beyond count / 2^32.
uint uniform_index(uint bits, uint count) {
  uint high;
  uint low;
  umulExtended(bits, count, high, low);
  return high;
}

/// The same, and what is left of the bits: uniform too, and independent of the index, in steps of `count`.
uint uniform_index(uint bits, uint count, out uint rest) {
  uint high;
  umulExtended(bits, count, high, rest);
  return high;
}

/// The entry itself or its alias.
uint alias_choice(uint index, uint alias, uint threshold, uint bits) { return bits < threshold ? index : alias; }

#endif
