"""TINs in the hands of other libraries, and theirs as TINs and surveys."""
