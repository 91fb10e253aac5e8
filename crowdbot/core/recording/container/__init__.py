"""The MCAP file: chunks, records and attachments, written and read within limits."""
