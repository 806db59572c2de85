"""Reads which libraries a shared library needs, and what it exports, from PE files of Windows and ELF files of Linux (64 bit).

Debian has pyelftools for the latter only: its pefile lacks the long names of sections, such as .debug_info.
"""

import struct

PE_IMPORTS, PE_EXPORTS = 1, 0  # indices of data directories
ELF_DYNAMIC, ELF_DYNAMIC_SYMBOLS = 6, 11  # types of sections
ELF_NEEDED = 1  # tag of a dynamic entry
ELF_UNDEFINED = 0  # section of symbols that another library defines
ELF_LOCAL = 0  # binding of symbols that are not exported


class LibraryFile:
    """machine: x86_64 or arm64. sections: names of sections. imports: names of libraries. exports: names of symbols."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        if self.data.startswith(b"MZ"):
            self._read_pe_sections()
            self.read_imports, self.read_exports = self._read_pe_imports, self._read_pe_exports
        elif self.data.startswith(b"\x7fELF\x02"):
            self._read_elf_sections()
            self.read_imports, self.read_exports = self._read_elf_imports, self._read_elf_exports
        else:
            raise ValueError("%s: is neither a PE file nor a 64-bit ELF file" % path)

    # Read when they are used, because files with debug information only have the sections, without their contents.
    @property
    def imports(self):
        return set(self.read_imports())

    @property
    def exports(self):
        return set(self.read_exports())

    def _unpack(self, form, offset):
        return struct.unpack_from("<" + form, self.data, offset)

    def _get_text(self, offset):
        return self.data[offset : self.data.index(b"\0", offset)].decode()

    def _read_pe_sections(self):
        (header,) = self._unpack("I", 0x3C)
        machine, count = self._unpack("HH", header + 4)
        symbols, symbol_count, optional_size = self._unpack("IIH", header + 12)
        self.machine = {0x8664: "x86_64", 0xAA64: "arm64"}[machine]
        self.directories = header + 24 + 112
        self.places = []  # of sections: address in memory, size, offset in the file
        self.sections = []
        for offset in range(header + 24 + optional_size, header + 24 + optional_size + 40 * count, 40):
            name = self.data[offset : offset + 8].rstrip(b"\0").decode()
            if name.startswith("/"):  # a long name, in the table of strings
                name = self._get_text(symbols + 18 * symbol_count + int(name[1:]))
            self.sections.append(name)
            size, address, _, place = self._unpack("IIII", offset + 8)
            self.places.append((address, size, place))

    def _locate(self, address):
        """Return the offset in the file of an address in memory."""
        return next(address - begin + place for begin, size, place in self.places if begin <= address < begin + size)

    def _read_pe_imports(self):
        (address,) = self._unpack("I", self.directories + 8 * PE_IMPORTS)
        entry = self._locate(address) if address else 0
        while entry and any(self._unpack("5I", entry)):
            yield self._get_text(self._locate(self._unpack("5I", entry)[3]))
            entry += 20

    def _read_pe_exports(self):
        (address,) = self._unpack("I", self.directories + 8 * PE_EXPORTS)
        if address:
            count, _, names = self._unpack("3I", self._locate(address) + 24)
            for name in self._unpack("%dI" % count, self._locate(names)):
                yield self._get_text(self._locate(name))

    def _read_elf_sections(self):
        (machine,) = self._unpack("H", 18)
        self.machine = {62: "x86_64", 183: "arm64"}[machine]
        (table,) = self._unpack("Q", 40)
        entry_size, count, names_index = self._unpack("HHH", 58)
        # Of each section: name, type, flags, address, offset, size, link.
        self.headers = [self._unpack("IIQQQQI", table + entry_size * index) for index in range(count)]
        self.sections = [self._get_text(self.headers[names_index][4] + header[0]) for header in self.headers]

    def _find_elf_entries(self, kind, entry_size):
        """Yield the offsets of the entries in sections of a type, each with the offset of their texts."""
        for _, found, _, _, offset, size, link in self.headers:
            if found == kind:
                for entry in range(offset, offset + size, entry_size):
                    yield entry, self.headers[link][4]

    def _read_elf_imports(self):
        for entry, texts in self._find_elf_entries(ELF_DYNAMIC, 16):
            tag, value = self._unpack("QQ", entry)
            if tag == ELF_NEEDED:
                yield self._get_text(texts + value)

    def _read_elf_exports(self):
        for entry, texts in self._find_elf_entries(ELF_DYNAMIC_SYMBOLS, 24):
            name, info, _, section = self._unpack("IBBH", entry)
            if section != ELF_UNDEFINED and info >> 4 != ELF_LOCAL:
                yield self._get_text(texts + name)
